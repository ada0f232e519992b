//! Memory is allocated only at the start.

use crate::problems::kepler;
use crate::problems::{Plain, plain};
use pfaff_integrators::{Dop853, Dopri5, Interval, Method, Options, OutputTimes, Tsit5, sample};
use std::ops::ControlFlow;

#[test]
fn the_number_of_allocations_does_not_depend_on_the_length() {
    check("dopri5", &Dopri5);
    check("tsit5", &Tsit5);
    check("dop853", &Dop853);
}

fn check(name: &str, method: &impl Method<Plain>) {
    let count = |t_end: f64| {
        let mut ode = plain(4, kepler);
        let (interval, options) = (Interval::new(0.0, t_end), Options::default());
        let times = OutputTimes::Every(0.1);
        let mut accepted = 0;
        let info = allocation_counter::measure(|| {
            let y0 = [1.0, 0.0, 0.0, 1.1];
            let end = sample(
                method,
                &mut ode,
                &interval,
                &y0,
                &options,
                &times,
                |_, _, _| ControlFlow::Continue(()),
            );
            accepted = end.expect("smooth problem").statistics.accepted;
        });
        (info.count_total, accepted)
    };
    let (short, long) = (count(1.0), count(200.0));
    assert!(long.1 > 10 * short.1, "{name}: {short:?} {long:?}");
    assert_eq!(short.0, long.0, "{name}");
}
