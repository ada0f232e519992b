//! Invalid values of options are rejected with the name of the option, before any computation.

use super::MotionOptions;

/// Returns the error message for changed options of a run over 10 s.
fn said(change: impl Fn(&mut MotionOptions)) -> Result<(), String> {
    let mut options = MotionOptions::to(10.0);
    change(&mut options);
    options.check().map_err(|e| e.to_string())
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    for rtol in [
        1e-30,
        9e-16,
        0.0,
        -1e-8,
        0.11,
        10.0,
        f64::NAN,
        f64::INFINITY,
    ] {
        let expected = format!("rtol is {rtol}, need a number from 1e-15 (rounding) to 0.1");
        assert_eq!(said(|o| o.rtol = rtol), Err(expected));
    }
    for atol in [0.0, -1e-10, f64::NAN, f64::INFINITY] {
        let expected = format!("atol is {atol}, need a number > 0");
        assert_eq!(said(|o| o.atol = atol), Err(expected));
    }
    for max_step in [0.0, -0.1, f64::NAN] {
        let expected = format!("max_step is {max_step}, need a time > 0");
        assert_eq!(said(|o| o.max_step = max_step), Err(expected));
    }
    for step in [0.0, -1.0, f64::NAN] {
        let expected = format!("output_step is {step}, need a time > 0");
        assert_eq!(said(|o| o.output_step = step), Err(expected));
    }
    for t_end in [-1.0, f64::NAN, f64::INFINITY] {
        let expected = format!("t_end is {t_end}, need a finite time ≥ 0");
        assert_eq!(said(|o| o.t_end = t_end), Err(expected));
    }
}

#[test]
fn runs_that_would_never_end_are_refused_by_name() {
    let too_many_rows = "output_step is 0.0000000001, need at least t_end/1e7, because the table would have too many rows";
    assert_eq!(said(|o| o.output_step = 1e-10), Err(too_many_rows.into()));
    let too_many_steps = "max_step is 0.000009, need at least t_end/max_steps, because otherwise the run cannot reach its end";
    assert_eq!(said(|o| o.max_step = 9e-6), Err(too_many_steps.into()));
}

#[test]
fn the_ends_of_the_ranges_are_right() {
    for rtol in [1e-15, 0.1] {
        assert_eq!(said(|o| o.rtol = rtol), Ok(()));
    }
    for step in [1e-6, f64::MAX] {
        assert_eq!(said(|o| o.output_step = step), Ok(()));
    }
    for max_step in [1e-5, f64::INFINITY] {
        assert_eq!(said(|o| o.max_step = max_step), Ok(()));
    }
    assert_eq!(said(|o| (o.t_end, o.output_step) = (0.0, 0.0)), Ok(()));
}

/// A full rotation is drawn in a figure of a thousand pixels, as chords between the output rows of
/// a run. The drawing deviates from a circle by at most a fifth of a pixel, and by at least a tenth
/// of this value. The deviation is `1 − cos(π/n)` of the radius.
#[test]
fn a_turn_is_as_round_as_a_picture_shows() {
    let rows = 1.0 / MotionOptions::to(1.0).output_step;
    let off = 500.0 * (1.0 - (std::f64::consts::PI / rows).cos());
    assert!((0.02..0.2).contains(&off), "{rows} rows: {off} pixels");
}
