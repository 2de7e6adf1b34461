//! Test how places of sensors are read and written.

use super::*;

#[test]
fn sites_are_read_as_they_were_written_and_as_people_write_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sensors.csv");
    let site = |part, x, normal| Site { part, position: [x, -0.5, 0.25], normal };
    let sites = vec![site(0, 0.1, [1.0, 0.0, 0.0]), site(2, 0.2, [0.0, 0.6, 0.8])];
    write_sites(&path, &sites).unwrap();
    assert_eq!(read_sites(&path).unwrap(), sites);
    std::fs::write(&path, "name,x,y,z,nx,ny,nz\na,0.1,-0.5,0.25,2,0,0\nb,0.2,-0.5,0.25,0,3,4\n").unwrap();
    let at_rest: Vec<Site> = sites.into_iter().map(|site| Site { part: 0, ..site }).collect();
    assert_eq!(read_sites(&path).unwrap(), at_rest);
}

#[test]
fn mistakes_are_named_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sensors.csv");
    for (rows, expected) in [
        ("1,0,0,1,0,0", "line 2: sensor 1 is where sensor 0 should be"),
        ("0,0,0,1,0,0\n1,inf,0,1,0,0", "line 3: x_m is inf"),
        ("0,0,0,0,0,0", "line 2: the normal of sensor 0 has no direction"),
        ("0,0,0,1e300,1e300,1e300", ""),
        ("0,a,0,1,0,0", "line 2: "),
    ] {
        std::fs::write(&path, format!("sensor,x,y,nx,ny,nz,z\n{}\n", rows.replace('\n', ",0\n") + ",0"))
            .unwrap();
        let found = read_sites(&path).map_err(|error| error.to_string());
        assert!(
            expected.is_empty() == found.is_ok() && found.err().unwrap_or_default().contains(expected),
            "{rows}"
        );
    }
}
