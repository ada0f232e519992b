//! Chains of four-bars of slender rods in space. Three of four rows of each loop beyond the first
//! are redundant, and all loops are in the singular configuration at the same instants. The moments
//! of inertia about the rods are negligible.

use std::fmt::Write as _;
use std::ops::ControlFlow;

use dynamics::MotionOptions;
use model::Registry;
use pfaff::{RunOptions, Study};

use crate::generated_scenes::angle;

const LOOPS: usize = 16;

/// The benchmark A02 of the IFToMM/LIM library in space, with this number of loops: rods of 1 kg
/// and 1 m, of radius 1 mm.
fn scene() -> String {
    let mut text =
        "[scene]\nname = \"rods\"\nspace = \"spatial\"\ngravity = [0, -9.81, 0]\n".to_owned();
    let mut body = |name: String, tensor: [f64; 3], [x, y]: [f64; 2], v: f64, turn: f64| {
        let _ = write!(
            text,
            "[[body]]\nname = \"{name}\"\nmass = 1.0\ninertia = {tensor:?}\n\
             position = [{x}, {y}, 0]\nvelocity = [{v}, 0, 0]\nangular_velocity = [0, 0, {turn}]\n"
        );
    };
    let (across, along) = (1.0 / 12.0, 5e-7);
    for k in 0..=LOOPS {
        let at = [k as f64, 0.5];
        body(
            format!("upright-{k}"),
            [across, along, across],
            at,
            0.5,
            -1.0,
        );
    }
    for k in 0..LOOPS {
        let at = [k as f64 + 0.5, 1.0];
        body(format!("link-{k}"), [along, across, across], at, 1.0, 0.0);
    }
    let mut joint = |name: String, bodies: [String; 2], [x, y]: [usize; 2]| {
        let _ = write!(
            text,
            "[[joint]]\nname = \"{name}\"\ntype = \"revolute\"\nbodies = {bodies:?}\n\
             at = [{x}, {y}, 0]\naxis = [0, 0, 1]\n"
        );
    };
    for k in 0..=LOOPS {
        let upright = format!("upright-{k}");
        joint(
            format!("foot-{k}"),
            ["ground".to_owned(), upright.clone()],
            [k, 0],
        );
        let links = [k.checked_sub(1), (k < LOOPS).then_some(k)];
        for link in links.into_iter().flatten() {
            let bodies = [upright.clone(), format!("link-{link}")];
            joint(format!("top-{k}-{link}"), bodies, [k, 1]);
        }
    }
    text
}

#[test]
fn flat_poses_of_slender_rods_are_passed_at_every_tolerance() {
    let registry = Registry::standard();
    let study = Study::read("rods.toml", &scene(), &registry, &RunOptions::default())
        .unwrap_or_else(|e| panic!("{e}"));
    let t_end = 2.0;
    let expected = angle(LOOPS, t_end);
    for exponent in 3..=10 {
        let rtol = 10_f64.powi(-exponent);
        let options = MotionOptions {
            rtol,
            atol: 1e-2 * rtol,
            output_step: t_end,
            ..MotionOptions::to(t_end)
        };
        let mut last = Vec::new();
        let run = study.run(&options, |sample| {
            last = sample.q.to_vec();
            Ok(ControlFlow::Continue(()))
        });
        run.unwrap_or_else(|e| panic!("rtol = {rtol:e}: {}", e.error));
        for k in 0..=LOOPS {
            let centre = [last[7 * k] - k as f64, last[7 * k + 1]];
            let off = (2.0 * centre[0] - expected.sin()).hypot(2.0 * centre[1] - expected.cos());
            assert!(off < 1e3 * rtol + 1e-7, "{k} at {rtol:e}: {off:e}");
        }
    }
}
