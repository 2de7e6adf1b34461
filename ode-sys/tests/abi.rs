//! The committed bindings against the library that is actually linked.

use std::ffi::CStr;
use std::mem::MaybeUninit;
use std::ptr::null_mut;
use std::sync::Once;

use ode_sys::*;

/// ODE is initialised once a process and then once a thread; tests run in threads.
fn initialise() {
    static ONCE: Once = Once::new();
    // SAFETY: `Once` keeps the first call alone, and the second is made in the thread that needs it.
    ONCE.call_once(|| assert_ne!(unsafe { dInitODE2(0) }, 0));
    assert_ne!(unsafe { dAllocateODEDataForThread(dAllocateMaskAll as u32) }, 0);
}

#[test]
fn scalar_and_struct_sizes_agree_with_the_compiled_header() {
    // SAFETY: both functions only return a constant.
    let (real, mass) = unsafe { (ode_shim_sizeof_real(), ode_shim_sizeof_mass()) };
    assert_eq!(real, size_of::<dReal>());
    assert_eq!(mass, size_of::<dMass>());
}

#[test]
fn the_linked_library_is_double_precision() {
    // SAFETY: the token is a terminated string.
    assert_eq!(unsafe { dCheckConfiguration(c"ODE_double_precision".as_ptr()) }, 1);
}

#[test]
fn structs_and_enumerations_mean_the_same_on_both_sides() {
    initialise();
    // SAFETY: every handle is live until its world is destroyed, and dMassSetCylinder writes the whole
    // structure.
    unsafe {
        let mut mass = MaybeUninit::<dMass>::uninit();
        dMassSetCylinder(mass.as_mut_ptr(), 1000.0, 3, 0.05, 0.3);
        let mass = mass.assume_init();
        let expected = 1000.0 * std::f64::consts::PI * 0.05 * 0.05 * 0.3;
        assert!((mass.mass - expected).abs() < 1e-12);
        assert!((mass.I[10] - 0.5 * expected * 0.05 * 0.05).abs() < 1e-12, "I_zz of a z cylinder");

        let world = dWorldCreate();
        let (first, second) = (dBodyCreate(world), dBodyCreate(world));
        dBodySetPosition(second, 1.0, 0.0, 0.0);
        let joint = dJointCreateUniversal(world, null_mut());
        assert_eq!(dJointGetType(joint), dJointTypeUniversal);
        dJointAttach(joint, first, second);
        dJointSetUniversalAnchor(joint, 0.25, 0.5, 0.75);
        let mut anchor: dVector3 = [0.0; 4];
        dJointGetUniversalAnchor(joint, anchor.as_mut_ptr());
        assert!(anchor.iter().zip([0.25, 0.5, 0.75]).all(|(a, b)| (a - b).abs() < 1e-12));
        dJointSetUniversalParam(joint, dParamFMax2 as i32, 7.0);
        assert_eq!(dJointGetUniversalParam(joint, dParamFMax2 as i32), 7.0);
        assert_eq!(dJointGetUniversalParam(joint, dParamFMax as i32), 0.0);
        dWorldDestroy(world);
    }
}

#[test]
fn a_message_from_ode_reaches_the_shim() {
    // SAFETY: the format takes the one integer that is passed, and the buffer is as long as it says.
    unsafe {
        ode_shim_install_handlers();
        dMessage(7, c"gain %d".as_ptr(), 42);
        let mut buffer = [0; 256];
        let length = ode_shim_take_message(buffer.as_mut_ptr(), buffer.len() as _);
        let text = CStr::from_ptr(buffer.as_ptr()).to_str().expect("ASCII");
        assert_eq!((text, length), ("ODE message 7: gain 42", text.len() as _));
        assert_eq!(ode_shim_take_message(buffer.as_mut_ptr(), buffer.len() as _), 0, "taken once");
    }
}

#[test]
fn a_fatal_error_within_a_step_is_returned() {
    initialise();
    // SAFETY: the handles are live; after the failed step the world is left alone, as the shim asks.
    unsafe {
        ode_shim_install_handlers();
        let world = dWorldCreate();
        let threading = dThreadingAllocateSelfThreadedImplementation();
        let functions = dThreadingImplementationGetFunctions(threading);
        dWorldSetStepThreadingImplementation(world, functions, threading);
        let body = dBodyCreate(world);
        assert_eq!(ode_shim_world_step(world, 0.01), 0);
        dBodyAddForce(body, f64::NAN, 0.0, 0.0);
        dBodySetPosition(body, f64::NAN, 0.0, 0.0);
        let failed = (0..3).any(|_| {
            dBodyAddForce(body, f64::NAN, f64::NAN, f64::NAN);
            ode_shim_world_step(world, f64::NAN) == 1
        });
        assert!(failed);
        let mut buffer = [0; 256];
        assert!(ode_shim_take_message(buffer.as_mut_ptr(), buffer.len() as _) > 0);
    }
}
