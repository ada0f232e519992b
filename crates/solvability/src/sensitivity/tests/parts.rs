//! A set with too many rows for dense matrices: each part on common cycles is examined with its own
//! data.

use joints::PointForce;

use super::*;
use crate::value::Sensitivity;

/// Number of bars of 0.1 m and 0.01 kg that hang in a row from the beam at rest.
const LINKS: usize = 320;

/// The beam of 2 m between a pin and a roller with its own weight of 10 N in the middle. A row of
/// hanging bars, or their weight as a force, loads it at a point 1.5 m from the pin.
fn loaded_beam(links: bool) -> Mechanism {
    let mut d = Description::new("beam");
    d.gravity = [0.0, -10.0];
    let beam = d.body(Body {
        position: [1.0, 0.0],
        ..Body::new("beam", 1.0, 1.0)
    });
    let (pin, slot) = ([-1.0, 0.0], [1.0, 0.0]);
    let at_pin = Revolute {
        s_i: pin,
        s_j: [0.0, 0.0],
    };
    d.joint("pin", &[beam, BodyRef::Ground], at_pin);
    let line = Line::new([0.0, 0.0], [2.0, 0.0]).expect("a line");
    d.joint("roller", &[beam], PointOnLine { s: slot, line });
    let mut above = (beam, [0.5, 0.0]);
    if !links {
        let weight = 10.0 * 0.01 * LINKS as f64;
        let force = d.force("weight", &[beam], PointForce { s: above.1 });
        force.functions = [0.0, -weight]
            .map(|f| Function::constant(f).expect("a number"))
            .to_vec();
        return Mechanism::build(&d).expect("it builds");
    }
    for k in 0..LINKS {
        let bar = d.body(Body {
            position: [1.5, -0.1 * k as f64 - 0.05],
            ..Body::new(&format!("bar {k}"), 0.01, 1e-5)
        });
        let hinge = Revolute {
            s_i: above.1,
            s_j: [0.0, 0.05],
        };
        d.joint(&format!("hinge {k}"), &[above.0, bar], hinge);
        above = (bar, [0.0, -0.05]);
    }
    Mechanism::build(&d).expect("it builds")
}

/// The load of the beam is the same for bars and for a force.
#[test]
fn a_part_is_asked_under_what_the_rest_does_to_it() {
    let sensitivities = |mechanism: &Mechanism| {
        let (q, _) = mechanism.described_state();
        let v = vec![0.0; mechanism.layout().n_v];
        let analysis = crate::analyse(mechanism, 0.0, &q).expect("finite");
        let found = analysis.sensitivities(mechanism, &q, &v);
        let found = found.expect("fits");
        assert!(found.left_out.is_empty(), "{:?}", found.left_out);
        found.each
    };
    let (hung, pushed) = (loaded_beam(true), loaded_beam(false));
    assert!(hung.layout().rows() > crate::limits::ROWS_MAX);
    let (hung, pushed) = (sensitivities(&hung), sensitivities(&pushed));
    assert!(hung.iter().all(|joint| joint.component("Fy").is_some()));
    for (hung, pushed) in hung.iter().zip(&pushed) {
        assert_eq!(hung.components.len(), pushed.components.len());
        for ((name, hung), (_, pushed)) in hung.components.iter().zip(&pushed.components) {
            assert!(
                (hung.change - pushed.change).abs() < 1e-9 * pushed.change + 1e-15,
                "{name}: {hung:?} {pushed:?}"
            );
            let by = |s: &Sensitivity| s.by.map(|by| (by.joint, by.name));
            assert_eq!(by(hung), by(pushed), "{name}");
        }
    }
}
