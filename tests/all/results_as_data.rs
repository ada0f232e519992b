//! The feature `serde` of the lower crates: results are data by the names of their fields, and NaN
//! is not a number in the data either.

use linalg::Matrix;
use pfaff::model::Registry;
use pfaff::{RunOptions, Study};
use serde_json::{json, to_value};

/// A beam between two pins, which share the force along it in an undetermined way.
const BEAM: &str = "
[scene]
space = 'plane'
name = 'beam'
[[body]]
name = 'beam'
mass = 2.0
inertia = 1.0
[[joint]]
name = 'left'
type = 'revolute'
bodies = ['ground', 'beam']
at = [-1.0, 0.0]
[[joint]]
name = 'right'
type = 'revolute'
bodies = ['ground', 'beam']
at = [1.0, 0.0]
";

#[test]
fn a_rank_is_data() {
    let c = Matrix::from_rows(&[[1.0, 0.0], [2.0, 0.0]]);
    let decision = rank::decide(&c, rank::Accuracy::Exact).expect("decided");
    let data = to_value(&decision).expect("data");
    assert_eq!((&data["rank"], &data["redundancy"]), (&json!(1), &json!(1)));
    // The larger row is independent; the other row is half of it.
    assert_eq!(data["coefficients"], json!([[0.5]]), "{data}");
    assert_eq!(data["kept"], json!([1]));
}

#[test]
fn verdicts_and_motions_are_data() {
    let study = Study::read(
        "beam.toml",
        BEAM,
        &Registry::standard(),
        &RunOptions::default(),
    );
    let study = study.expect("a scene");
    let analysis = study.analyse(0.0, None).expect("analysed").analysis;
    let data = to_value(&*analysis).expect("data");
    assert_eq!(data["decision"]["rank"], json!(3), "{data}");
    let first = &data["reactions"][0];
    assert_eq!(first["name"], json!("left"));
    let along = &first["components"][0];
    assert_eq!(along["name"], json!("Fx"));
    assert_eq!(along["judgement"]["verdict"], json!("NotUnique"), "{along}");
}

#[test]
fn what_an_integration_cost_is_data() {
    use integrators::{Dop853, Function, Interval, Options, integrate};
    use std::ops::ControlFlow;
    let mut decay = Function::new(1, |_t, y: &[f64], dy: &mut [f64]| dy[0] = -y[0]);
    let interval = Interval::new(0.0, 1.0);
    let options = Options::with_tolerance(1e-8, 1e-8);
    let end = integrate(&Dop853, &mut decay, &interval, &[1.0], &options, |_| {
        ControlFlow::Continue(())
    });
    let data = to_value(end.expect("integrated")).expect("data");
    assert_eq!(data["t"], json!(1.0));
    assert!(
        data["statistics"]["evaluations"]
            .as_u64()
            .is_some_and(|n| n > 10),
        "{data}"
    );
}
