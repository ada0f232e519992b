//! Simulates ten seconds of the robot with its trolley by code that was generated for it. No scene
//! is read, no mechanism is assembled, and no state is projected.

mod robot;

use std::ops::ControlFlow;

use integrators::{Dop853, Function, Interval, Options, integrate};
use robot::{BREAK_TIMES, N_Q, N_V};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut ode = Function::new(N_Q + N_V, |t, y: &[f64], dy: &mut [f64]| {
        let (Some((q, rest)), Some((qd, a))) = (y.split_first_chunk(), dy.split_first_chunk_mut())
        else {
            return;
        };
        if let (Some(v), Some(a)) = (rest.first_chunk(), a.first_chunk_mut()) {
            robot::acceleration(t, q, v, a);
            *qd = *v;
        }
    });
    let mut start = [0.0; N_Q + N_V];
    let positions = [
        [0.0, 0.0],
        [0.255, 0.025],
        [-0.255, 0.025],
        [0.205, -0.075],
        [-0.205, -0.075],
        [0.0, -0.2],
        [-0.75, 0.0],
    ];
    for (k, [x, y]) in positions.into_iter().enumerate() {
        (start[3 * k], start[3 * k + 1], start[N_Q + 3 * k]) = (x, y, 1.0);
    }
    let interval = Interval {
        t0: 0.0,
        t_end: 10.0,
        break_times: &BREAK_TIMES,
    };
    let options = Options::with_tolerance(1e-9, 1e-11);
    let end = integrate(&Dop853, &mut ode, &interval, &start, &options, |_| {
        ControlFlow::Continue(())
    })?;
    println!(
        "platform at {:?} after {} steps",
        &end.y[..3],
        end.statistics.accepted
    );
    Ok(())
}
