//! Integrates Van der Pol's oscillator to t = 20.

use std::ops::ControlFlow;

use integrators::{Dop853, Function, Interval, Options, integrate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut ode = Function::new(2, |_t, y: &[f64], dy: &mut [f64]| {
        dy[0] = y[1];
        dy[1] = (1.0 - y[0] * y[0]) * y[1] - y[0];
    });
    let interval = Interval::new(0.0, 20.0);
    let options = Options::with_tolerance(1e-9, 1e-9);
    let end = integrate(&Dop853, &mut ode, &interval, &[2.0, 0.0], &options, |_| {
        ControlFlow::Continue(())
    })?;
    println!("{:?} in {} steps", end.y, end.statistics.accepted);
    Ok(())
}
