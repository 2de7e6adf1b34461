//! Finds Debian's libode, compiles the C shim (which asserts double precision), and, with the feature
//! `bindgen`, regenerates the bindings into `OUT_DIR`.

fn main() {
    println!("cargo:rerun-if-changed=wrapper.h");
    println!("cargo:rerun-if-changed=shim.h");
    println!("cargo:rerun-if-changed=shim.c");
    println!("cargo:rerun-if-env-changed=DOCS_RS");

    // docs.rs sets it, has no ODE, and links nothing.
    if std::env::var_os("DOCS_RS").is_some() {
        println!("cargo:version=unknown");
        return;
    }

    let ode = pkg_config::Config::new().atleast_version("0.16").probe("ode").unwrap_or_else(|error| {
        panic!("ODE is missing: run `apt-get install libode-dev pkg-config` ({error})")
    });

    let mut shim = cc::Build::new();
    shim.file("shim.c").includes(&ode.include_paths).std("c11");
    shim.warnings_into_errors(true).compile("ode_shim");

    // Read by the dependent package's build script as DEP_ODE_VERSION.
    println!("cargo:version={}", ode.version);

    #[cfg(feature = "bindgen")]
    generate_bindings(&ode);
}

#[cfg(feature = "bindgen")]
fn generate_bindings(ode: &pkg_config::Library) {
    const FUNCTIONS: &[&str] = &[
        "dInitODE2",
        "dAllocateODEDataForThread",
        "dGetConfiguration",
        "dCheckConfiguration",
        "dMessage",
        "dWorldCreate",
        "dWorldDestroy",
        "dWorldSetCFM",
        "dWorldSetStepThreadingImplementation",
        "dThreadingAllocateSelfThreadedImplementation",
        "dThreadingImplementationGetFunctions",
        "dThreadingFreeImplementation",
        "dMassSet(Cylinder|Capsule|Sphere|Box)",
        "dBodyCreate",
        "dBodyAdd(Force|Torque)",
        "dBodySet(Mass|Position|Rotation|LinearVel|AngularVel)",
        "dBodyGet(Position|Rotation|LinearVel|AngularVel)",
        "dJointCreate(Universal|Hinge|Ball|AMotor)",
        "dJointAttach",
        "dJointGetType",
        "dJointSetUniversal(Anchor|Axis1|Axis2|Param)",
        "dJointGetUniversal(Anchor|Anchor2|Angles|Angle1Rate|Angle2Rate|Param)",
        "dJointAddUniversalTorques",
        "dJointSetHinge(Anchor|Axis|Param)",
        "dJointGetHinge(Anchor|Anchor2|Angle|AngleRate)",
        "dJointAddHingeTorque",
        "dJointSetBallAnchor",
        "dJointGetBall(Anchor|Anchor2)",
        "dJointSetAMotor(Mode|NumAxes|Axis|Param)",
        "dJointAddAMotorTorques",
        "ode_shim_.*",
    ];
    const TYPES: &[&str] = &["dJointType", "dMass", "dAllocateODEDataFlags"];

    let mut builder = bindgen::Builder::default()
        .header("wrapper.h")
        .clang_args(ode.include_paths.iter().map(|path| format!("-I{}", path.display())))
        .rust_edition(bindgen::RustEdition::Edition2024)
        .prepend_enum_name(false)
        .allowlist_var("dParam(Vel|FMax)[123]?|dAMotorUser")
        .allowlist_recursively(true)
        .generate_comments(false)
        .layout_tests(true);
    for function in FUNCTIONS {
        builder = builder.allowlist_function(function);
    }
    for name in TYPES {
        builder = builder.allowlist_type(name);
    }
    let target =
        std::path::Path::new(&std::env::var("OUT_DIR").expect("cargo sets OUT_DIR")).join("bindings.rs");
    builder
        .generate()
        .expect("bindgen reads ODE's header; it needs `apt-get install libclang-dev`")
        .write_to_file(target)
        .expect("OUT_DIR is writable");
}
