//! Compares the Arenstorf orbit with published results of the original program, and with snapshots
//! of cost and error.

use crate::problems::arenstorf::{PERIOD, Y0, rhs};
use crate::problems::{Plain, distance, plain, run_function};
use pfaff_integrators::{
    Dop853, Dopri5, Function, InitialStep, Interval, Method, Options, OutputTimes, Tsit5,
    integrate, sample,
};
use std::ops::ControlFlow;

/// Output of the Fortran program DOPRI5 of E. Hairer and G. Wanner for its example at rtol = atol =
/// 1e-7, as quoted in the examples of the R package deSolve: time, x, y.
const PUBLISHED_ROWS: [(f64, f64, f64); 8] = [
    (2.0, -0.579_878_141_1, 0.609_077_525_1),
    (4.0, -0.198_333_527_0, 1.137_638_086),
    (6.0, -0.473_574_394_3, 0.223_906_811_8),
    (8.0, -1.174_553_350, -0.275_946_698_2),
    (10.0, -0.839_807_346_6, 0.446_830_226_8),
    (12.0, 0.013_147_124_68, -0.838_575_149_9),
    (14.0, -0.603_112_950_4, -0.991_259_803_1),
    (16.0, 0.242_711_099_9, -0.389_994_883_3),
];
const PUBLISHED_END: [f64; 2] = [0.994_002_101_6, 8.911_185_692e-6];
/// Tolerance for the printed values. Half a unit of their last digit is 5e-11 to 5e-10, and this
/// orbit amplifies the different rounding errors of another compiler.
const PRINTED: f64 = 1e-9;

#[test]
fn reproduces_the_published_run_of_the_original_program() {
    let mut ode = Function::new(4, rhs);
    let mut rows = PUBLISHED_ROWS.iter();
    let mut y = [0.0; 4];
    let mut next = rows.next();
    let options = Options::with_tolerance(1e-7, 1e-7);
    let interval = Interval::new(0.0, PERIOD);
    let end = integrate(&Dopri5, &mut ode, &interval, &Y0, &options, |step| {
        while let Some(row) = next.filter(|row| row.0 <= step.t1()) {
            step.interpolate(row.0, &mut y).expect("inside");
            assert!(
                distance(&y[..2], &[row.1, row.2]) < PRINTED,
                "{row:?}: {y:?}"
            );
            next = rows.next();
        }
        ControlFlow::Continue(())
    })
    .expect("the orbit is smooth");
    assert!(next.is_none());
    assert!(
        distance(&end.y[..2], &PUBLISHED_END) < PRINTED,
        "{:?}",
        end.y
    );
    // The published counts are fcn = 1442, step = 240, accpt = 216; the original does not count its
    // 2 rejections before the first accepted step.
    let s = end.statistics;
    assert_eq!((s.evaluations, s.accepted, s.rejected()), (1442, 216, 24));
}

/// The original program started with h = 1e-4, as quoted in the tests of the crate russell_ode (MIT
/// licence).
#[test]
fn reproduces_the_original_program_with_given_first_step() {
    let options = Options {
        initial_step: InitialStep::Given(1e-4),
        ..Options::with_tolerance(1e-7, 1e-7)
    };
    let end = run_function(rhs, (0.0, PERIOD), &Y0, &options);
    let quoted = [
        9.940_021_704_030_663e-1,
        9.040_891_036_151_961e-6,
        1.459_758_305_600_828e-3,
        -2.001_245_515_834_718,
    ];
    assert!(distance(&end.y, &quoted) < PRINTED, "{:?}", end.y);
    let s = end.statistics;
    assert_eq!((s.evaluations, s.accepted, s.rejected()), (1429, 217, 21));
}

/// Snapshot of a run: rtol = atol, evaluations, accepted, rejected, error at the end after one
/// period (rounded up).
type Snapshot = (f64, u64, u64, u64, f64);

fn check_snapshots(name: &str, method: &impl Method<Plain>, snapshots: [Snapshot; 3]) {
    for (tolerance, evaluations, accepted, rejected, error) in snapshots {
        let options = Options::with_tolerance(tolerance, tolerance);
        let interval = Interval::new(0.0, PERIOD);
        let mut ode = plain(4, rhs);
        let end = integrate(method, &mut ode, &interval, &Y0, &options, |_| {
            ControlFlow::Continue(())
        })
        .expect("the orbit is smooth");
        let s = end.statistics;
        let found = distance(&end.y, &Y0);
        let counts = (s.evaluations, s.accepted, s.rejected());
        assert_eq!(
            counts,
            (evaluations, accepted, rejected),
            "{name}, tolerance {tolerance}, error {found:.2e}"
        );
        assert!(
            found < error,
            "{name}, tolerance {tolerance}: error {found:.3e}"
        );
    }
}

#[test]
fn costs_and_errors_are_as_recorded() {
    let pairs = [
        (1e-6, 986, 139, 25, 4.1e-2),
        (1e-9, 3212, 530, 5, 2.0e-5),
        (1e-12, 12692, 2113, 2, 3.0e-8),
    ];
    check_snapshots("dopri5", &Dopri5, pairs);
    let tsit5 = [
        (1e-6, 1076, 144, 35, 2.8e-2),
        (1e-9, 3284, 544, 3, 3.7e-6),
        (1e-12, 13022, 2168, 2, 3.0e-9),
    ];
    check_snapshots("tsit5", &Tsit5, tsit5);
    // The original program needs 1036, 2185 and 4250 evaluations, with an error of 1.6e-9 (as
    // measured with other ports of it).
    let dop853 = [
        (1e-6, 1035, 65, 23, 7.0e-3),
        (1e-9, 2184, 136, 50, 7.4e-6),
        (1e-12, 4249, 298, 61, 2.0e-9),
    ];
    check_snapshots("dop853", &Dop853, dop853);
}

/// Rows are as accurate as steps. The test compares rows and steps with a much more accurate run;
/// the largest distances must be similar.
#[test]
fn rows_are_as_accurate_as_steps() {
    check_rows("dopri5", &Dopri5, 1.5);
    check_rows("tsit5", &Tsit5, 1.5);
    check_rows("dop853", &Dop853, 1.5);
}

fn check_rows(name: &str, method: &impl Method<Plain>, factor: f64) {
    let rows = |tolerance: f64, times: &OutputTimes| {
        let mut ode = plain(4, rhs);
        let mut rows = Vec::new();
        let options = Options::with_tolerance(tolerance, tolerance);
        let interval = Interval::new(0.0, PERIOD / 2.0);
        sample(
            method,
            &mut ode,
            &interval,
            &Y0,
            &options,
            times,
            |_, t, y| {
                rows.push((t, [y[0], y[1], y[2], y[3]]));
                ControlFlow::Continue(())
            },
        )
        .expect("the orbit is smooth");
        rows
    };
    let worst = |a: &[(f64, [f64; 4])], b: &[(f64, [f64; 4])]| {
        assert_eq!(a.len(), b.len());
        a.iter()
            .zip(b)
            .map(|(a, b)| distance(&a.1, &b.1))
            .fold(0.0, f64::max)
    };
    let mut step_ends = vec![0.0];
    let interval = Interval::new(0.0, PERIOD / 2.0);
    let options = Options::with_tolerance(1e-8, 1e-8);
    integrate(
        method,
        &mut plain(4, rhs),
        &interval,
        &Y0,
        &options,
        |step| {
            step_ends.push(step.t1());
            ControlFlow::Continue(())
        },
    )
    .expect("the orbit is smooth");
    let (at_steps, between) = (OutputTimes::At(step_ends), OutputTimes::Every(0.01));
    let step_error = worst(&rows(1e-8, &at_steps), &rows(1e-13, &at_steps));
    let row_error = worst(&rows(1e-8, &between), &rows(1e-13, &between));
    assert!(
        row_error < factor * step_error,
        "{name}: rows {row_error:.2e}, steps {step_error:.2e}"
    );
}
