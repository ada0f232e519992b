//! Probe.
use dynamics::{MotionOptions, RowChoice, prepare, simulate};
use joints::Revolute;
use model::{Body, BodyRef, Description, Joint, Mechanism, StartOptions};
use std::ops::ControlFlow;

fn four_bars(n: usize, th: f64, w: f64) -> Description {
    let mut d = Description {
        gravity: [0.0, -9.81],
        ..Description::default()
    };
    let (s, c) = th.sin_cos();
    for i in 0..=n {
        d.bodies.push(Body {
            name: format!("u{i}"),
            mass: 1.0,
            inertia: 1.0 / 12.0,
            position: [i as f64 + 0.5 * s, 0.5 * c],
            angle: -th,
            velocity: [0.5 * c * w, -0.5 * s * w],
            angular_velocity: -w,
            ..Body::default()
        });
    }
    for i in 0..n {
        d.bodies.push(Body {
            name: format!("r{i}"),
            mass: 1.0,
            inertia: 1.0 / 12.0,
            position: [i as f64 + 0.5 + s, c],
            velocity: [c * w, -s * w],
            ..Body::default()
        });
    }
    for i in 0..=n {
        d.joints.push(Joint::new(
            &format!("g{i}"),
            &[BodyRef::Ground, BodyRef::Body(i)],
            Revolute {
                s_i: [i as f64, 0.0],
                s_j: [0.0, -0.5],
            },
        ));
    }
    for i in 0..n {
        d.joints.push(Joint::new(
            &format!("a{i}"),
            &[BodyRef::Body(i), BodyRef::Body(n + 1 + i)],
            Revolute {
                s_i: [0.0, 0.5],
                s_j: [-0.5, 0.0],
            },
        ));
        d.joints.push(Joint::new(
            &format!("b{i}"),
            &[BodyRef::Body(i + 1), BodyRef::Body(n + 1 + i)],
            Revolute {
                s_i: [0.0, 0.5],
                s_j: [0.5, 0.0],
            },
        ));
    }
    d
}

fn main() {
    let n: usize = std::env::args().nth(1).map_or(2, |s| s.parse().unwrap());
    let (mut wrong, mut failed, mut worst) = (0, 0, 0.0_f64);
    for k in 0..64 {
        let tol = 10f64.powf(-4.0 - 8.0 * k as f64 / 63.0);
        let m = Mechanism::build(&four_bars(n, 0.0, 1.0)).unwrap();
        let p = prepare(m, &StartOptions::default(), &RowChoice::Automatic).unwrap();
        let o = MotionOptions {
            rtol: tol,
            atol: tol,
            output_step: 10.0,
            method: match std::env::args().nth(2).as_deref() {
                Some("8") => dynamics::Method::Dop853,
                Some("t") => dynamics::Method::Tsit5,
                _ => dynamics::Method::Dopri5,
            },
            ..MotionOptions::to(10.0)
        };
        let mut q = vec![];
        match simulate(&p, &o, |s| {
            q = s.q.to_vec();
            Ok(ControlFlow::Continue(()))
        }) {
            Ok(s) => {
                // B0 = u0 centre*2
                let (x, y) = (2.0 * q[0], 2.0 * q[1]);
                let e = (x - 0.3284581115).hypot(y - 0.9445185378);
                if n == 2 {
                    if e > 0.3 {
                        wrong += 1;
                    }
                    if tol <= 1e-7 {
                        worst = worst.max(e);
                    }
                }
                println!(
                    "{tol:.1e} steps {} rej {} ev {} err {e:.1e} phi {:.1e} v {:.1e} E {:.1e} ms {:.1} {}",
                    s.steps,
                    s.rejected,
                    s.evaluations,
                    s.max_position_residual,
                    s.max_velocity_residual,
                    s.energy_balance,
                    1e3 * s.wall_seconds,
                    s.events.len()
                );
            }
            Err(f) => {
                failed += 1;
                println!("{tol:.1e} t {} FAIL {}", f.summary.t, f.error);
            }
        }
    }
    if let Some(e) = std::env::args().nth(3) {
        println!("{e}");
    }
    println!("wrong {wrong} failed {failed} worst {worst:.1e}");
}
