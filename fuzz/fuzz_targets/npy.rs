//! Fuzz the readers of pressures, symbols, distances and body maps; what is accepted goes through the stages that
//! follow.

#![no_main]

use bodyschema::files::npy;
use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::baselines::{ClusteringMethod, cluster};
use bodyschema::stages::body_map::{BodyMap, ClassicalScaling, Fit, smacof};
use bodyschema::stages::distance::{Distances, information_metric};
use bodyschema::stages::quantise::{Quantise, Scheme, quantise};
use bodyschema::stages::schema::{Model, infer};
use bodyschema_fuzz::{accepted, file};
use libfuzzer_sys::fuzz_target;

/// Most sensors and dimensions that go on.
const FEW: usize = 32;

fuzz_target!(|data: &[u8]| {
    let path = file("input.npy", data);
    if let Some(tactile) = accepted(npy::read_tactile(&path)) {
        assert!(tactile.pressures.iter().all(|pressure| pressure.is_finite() && *pressure >= 0.0));
        if tactile.sensors() <= FEW {
            for scheme in [Scheme::PerSensor, Scheme::Pooled, Scheme::EqualWidth] {
                map(&information_metric(&quantise(&tactile, &Quantise { scheme, levels: 4 })));
            }
        }
    }
    if let Some(symbols) = accepted(npy::read_symbols(&path))
        && symbols.sensors() <= FEW
    {
        assert!(symbols.values.iter().all(|symbol| usize::from(*symbol) < symbols.levels));
        map(&information_metric(&symbols));
    }
    if let Some(distances) = accepted(npy::read_distances(&path))
        && distances.sensors <= FEW
    {
        map(&distances);
    }
    if let Some(body_map) = accepted(npy::read_body_map(&path)) {
        infer_and_cluster(&body_map);
    }
});

fn map(distances: &Distances) {
    assert!(distances.values.iter().all(|distance| distance.is_finite() && *distance >= 0.0));
    let Some(scaling) = accepted(ClassicalScaling::new(distances, 2)) else { return };
    for dims in [1, 2] {
        if let Some(body_map) = accepted(scaling.coordinates(dims)) {
            for fit in [Fit::Metric, Fit::Nonmetric] {
                let (improved, found) = smacof(distances, body_map.clone(), fit);
                assert!(improved.coordinates.iter().all(|x| x.is_finite()), "{found:?}");
                assert!(found.stress <= found.start + 1e-9, "{found:?}");
            }
            infer_and_cluster(&body_map);
        }
    }
}

fn infer_and_cluster(body_map: &BodyMap) {
    assert!(body_map.coordinates.iter().all(|x| x.is_finite()));
    let mut settings = Settings::paper().schema;
    (settings.components, settings.chains, settings.sweeps) = (3, 1, 2);
    for model in Model::ALL {
        if body_map.dims <= FEW {
            let draws = accepted(infer(body_map, model, &settings, 1, 1, &|| ()));
            for draw in draws.into_iter().flatten() {
                assert!(draw.log_posterior.is_some_and(f64::is_finite), "{draw:?}");
            }
        }
    }
    // The clusterings take what the mixtures refuse, but squares must be finite.
    if body_map.points() <= FEW && body_map.coordinates.iter().all(|x| x.abs() < 1e100) {
        for method in ClusteringMethod::ALL {
            let labels = cluster(method, body_map, 3, 2, &mut stream(1, 1, "fuzz", 0));
            assert!(labels.len() == body_map.points() && labels.iter().all(|label| *label < body_map.points()));
        }
    }
}
