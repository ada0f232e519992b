//! Event times are compared with closed forms; the module also tests events that are not detected.

use crate::problems::{Plain, fixed_step, plain};
use pfaff_integrators::{
    Crossing, Crossings, Direction, Dop853, Dopri5, End, Function, IntegrationError, Interval,
    Method, Options, OutputTimes, Rows, Tsit5, integrate, integrate_until,
};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

/// The equation is θ'' = −sin θ.
fn pendulum(_t: f64, y: &[f64], dy: &mut [f64]) {
    dy.copy_from_slice(&[y[1], -y[0].sin()]);
}

/// Returns the period 2π/agm(1, cos(amplitude/2)), by the arithmetic-geometric mean.
fn period(amplitude: f64) -> f64 {
    let (mut a, mut g) = (1.0, (0.5 * amplitude).cos());
    for _ in 0..6 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    2.0 * PI / a
}

fn vertical_passages(method: &impl Method<Plain>, direction: Direction) -> Vec<Crossing> {
    let options = Options::with_tolerance(1e-13, 1e-13);
    let interval = Interval::new(0.0, 2.9 * period(FRAC_PI_2));
    let (mut crossings, mut passages) = (Crossings::new(direction), Vec::new());
    let y0 = [FRAC_PI_2, 0.0];
    integrate(
        method,
        &mut plain(2, pendulum),
        &interval,
        &y0,
        &options,
        |step| {
            let found = crossings.locate(step, |_, _, y| y[0]);
            passages.extend_from_slice(found.expect("defined"));
            ControlFlow::Continue(())
        },
    )
    .expect("smooth problem");
    passages
}

/// Released at 90°, the pendulum passes the vertical at ¼, ¾, 5/4, … periods.
#[test]
fn a_pendulum_passes_the_vertical_on_time() {
    // Errors of two to three periods at tolerance 1e-13.
    const ERROR: f64 = 5e-12;
    let check = |passages: &[Crossing], quarters: &[f64]| {
        assert_eq!(passages.len(), quarters.len(), "{passages:?}");
        for (crossing, quarter) in passages.iter().zip(quarters) {
            let exact = quarter / 4.0 * period(FRAC_PI_2);
            assert!((crossing.t - exact).abs() < ERROR, "{crossing:?}, {exact}");
            assert_eq!(crossing.is_rising, quarter % 4.0 == 3.0);
        }
    };
    let all = [1.0, 3.0, 5.0, 7.0, 9.0, 11.0];
    check(&vertical_passages(&Dop853, Direction::Any), &all);
    check(&vertical_passages(&Dopri5, Direction::Any), &all);
    check(
        &vertical_passages(&Tsit5, Direction::Falling),
        &[1.0, 5.0, 9.0],
    );
    check(
        &vertical_passages(&Dop853, Direction::Rising),
        &[3.0, 7.0, 11.0],
    );
}

/// A ball is dropped from 1 m (g = 2 m/s²). After each landing it leaves the ground with half the
/// speed v. It lands at 1 s, and then 2·v/g = v after each start.
#[test]
fn a_bouncing_ball_lands_when_it_should() {
    let mut fall = Function::new(2, |_t, y: &[f64], dy: &mut [f64]| {
        dy.copy_from_slice(&[y[1], -2.0]);
    });
    let options = Options::default();
    let (mut t, mut y) = (0.0, vec![1.0, 0.0]);
    let (mut landing, mut speed) = (1.0, 2.0);
    for bounce in 0..20 {
        let rest = Interval::new(t, 10.0);
        let height = |_: &mut _, _t: f64, y: &[f64]| y[0];
        let end = integrate_until(
            &Dopri5,
            &mut fall,
            &rest,
            &y,
            &options,
            Direction::Falling,
            height,
        )
        .expect("free fall");
        assert_eq!(end.end, End::Stopped);
        // Rounding error of t and y over some ten steps; the inversion of the height amplifies it
        // by 1/speed.
        let error = 1e-15 / speed;
        assert!(
            (end.t - landing).abs() < 20.0 * error,
            "bounce {bounce}: {} {landing}",
            end.t
        );
        assert!(
            (end.y[1] + speed).abs() < 2e-14,
            "bounce {bounce}: {}",
            end.y[1]
        );
        assert!(end.y[0] <= 0.0, "the ball has arrived: {}", end.y[0]);
        (t, y) = (end.t, vec![end.y[0], -0.5 * end.y[1]]);
        speed *= 0.5;
        landing += speed;
    }
}

/// Returns the zero crossings of a function of time in one step from 0 to 1.
fn in_one_step(direction: Direction, g: impl Fn(f64) -> f64) -> Vec<Crossing> {
    let mut clock = Function::new(1, |_t, _y: &[f64], dy: &mut [f64]| dy[0] = 1.0);
    let mut crossings = Crossings::new(direction);
    let mut found = Vec::new();
    let interval = Interval::new(0.0, 1.0);
    integrate(
        &Dop853,
        &mut clock,
        &interval,
        &[0.0],
        &fixed_step(1.0),
        |step| {
            found.extend_from_slice(crossings.locate(step, |_, t, _y| g(t)).expect("a number"));
            ControlFlow::Continue(())
        },
    )
    .expect("a clock");
    found
}

#[test]
fn several_zeros_in_one_step() {
    let g = |t: f64| (t - 0.23) * (t - 0.51) * (t - 0.84);
    let times = |direction| -> Vec<f64> { in_one_step(direction, g).iter().map(|c| c.t).collect() };
    let close = |found: &[f64], exact: &[f64]| {
        assert_eq!(found.len(), exact.len(), "{found:?}");
        assert!(
            found.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-15),
            "{found:?}"
        );
    };
    close(&times(Direction::Any), &[0.23, 0.51, 0.84]);
    close(&times(Direction::Rising), &[0.23, 0.84]);
    close(&times(Direction::Falling), &[0.51]);
}

#[test]
fn zeros_at_ends_count_once_and_contacts_are_not_seen() {
    // A zero at the end of the only step counts; a zero at the start of the integration does not.
    let end = in_one_step(Direction::Any, |t| t - 1.0);
    assert_eq!(
        end,
        [Crossing {
            t: 1.0,
            is_rising: true
        }]
    );
    assert_eq!(in_one_step(Direction::Any, |t| t), []);
    // Two cases are documented as not detected: a contact between two points, and two zeros between
    // them.
    assert_eq!(in_one_step(Direction::Any, |t| (t - 0.55).powi(2)), []);
    assert_eq!(in_one_step(Direction::Any, |t| (t - 0.54) * (t - 0.56)), []);
    // A jump has no zero; the time just after it is found.
    let jump = in_one_step(Direction::Any, |t| if t < 0.3 { -1.0 } else { 2.0 });
    assert!((jump[0].t - 0.3).abs() < 1e-15 && jump[0].t >= 0.3);
}

/// Backwards in time the order of events is reversed, and rising and falling zeros are exchanged.
#[test]
fn backwards() {
    let mut clock = Function::new(1, |_t, _y: &[f64], dy: &mut [f64]| dy[0] = 1.0);
    let g = |_: &mut _, _t: f64, y: &[f64]| (y[0] - 1.0) * (y[0] - 2.0);
    let back = Interval::new(3.0, 0.0);
    let options = Options::default();
    let end = integrate_until(
        &Tsit5,
        &mut clock,
        &back,
        &[3.0],
        &options,
        Direction::Falling,
        g,
    )
    .expect("a clock");
    assert!((end.t - 2.0).abs() < 1e-14, "{}", end.t);
    let end = integrate_until(
        &Tsit5,
        &mut clock,
        &back,
        &[3.0],
        &options,
        Direction::Rising,
        g,
    )
    .expect("a clock");
    assert!((end.t - 1.0).abs() < 1e-14, "{}", end.t);
    let never = |_: &mut _, _t: f64, _y: &[f64]| 1.0;
    let end = integrate_until(
        &Tsit5,
        &mut clock,
        &back,
        &[3.0],
        &options,
        Direction::Any,
        never,
    )
    .expect("a clock");
    assert_eq!((end.end, end.t), (End::Reached, 0.0));
}

/// One observer receives the rows up to an event, and the event.
#[test]
fn rows_stop_at_an_event() {
    let interval = Interval::new(0.0, 10.0);
    let mut ode = plain(2, pendulum);
    let options = Options::default();
    let mut crossings = Crossings::new(Direction::Falling);
    let mut rows = Rows::new::<std::convert::Infallible>(OutputTimes::Every(0.5), &interval)
        .expect("good times");
    let mut times = Vec::new();
    let y0 = [FRAC_PI_2, 0.0];
    let mut write = |_: &mut Plain, t: f64, _y: &mut [f64]| {
        times.push(t);
        ControlFlow::Continue(())
    };
    assert!(rows.start(&mut ode, &y0, &mut write).is_continue());
    let end = integrate(&Dop853, &mut ode, &interval, &y0, &options, |step| {
        let event = crossings
            .locate(step, |_, _, y| y[0])
            .expect("defined")
            .first()
            .copied();
        let stop = event.map_or(step.t1(), |crossing| crossing.t);
        rows.emit_until(stop, step, &mut write).expect("smooth")?;
        if event.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })
    .expect("smooth problem");
    assert!(end.end == End::Stopped && end.t >= period(FRAC_PI_2) / 4.0);
    assert_eq!(times, [0.0, 0.5, 1.0, 1.5]); // a quarter of the period is 1.854
}

#[test]
fn an_undefined_event_is_named() {
    let mut clock = Function::new(1, |_t, _y: &[f64], dy: &mut [f64]| dy[0] = 1.0);
    let (interval, options) = (Interval::new(0.0, 1.0), fixed_step(1.0));
    let g = |_: &mut _, t: f64, _y: &[f64]| (0.55 - t).sqrt();
    let failure = integrate_until(
        &Dopri5,
        &mut clock,
        &interval,
        &[0.0],
        &options,
        Direction::Any,
        g,
    )
    .expect_err("the root of a negative number");
    assert!(
        matches!(failure.error, IntegrationError::EventUndefined { t } if (t - 0.6).abs() < 1e-15),
        "{failure}"
    );
}
