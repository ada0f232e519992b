//! Every case of the suite at a tight tolerance, against its reference.

use pfaff::work_precision::{Curve, Subject};

#[test]
fn explore() {
    for case in suite::all() {
        let subject = match Subject::of_case(case) {
            Ok(s) => s,
            Err(e) => {
                println!("{}: {e}", case.name);
                continue;
            }
        };
        for tol in [1e-9, 1e-11, 1e-12, 1e-13] {
            let curve = Curve {
                method: Default::default(),
                formulation: Default::default(),
                stabilisation: Default::default(),
            };
            if case.name.starts_with("stiff-cr") {
                continue;
            }
            let clock = std::time::Instant::now();
            match subject.errors(curve, tol) {
                Ok(Some(e)) => println!(
                    "{} {tol:e}: {:?} state {:.1e} ({:.1} s)",
                    case.name,
                    e.scaled,
                    e.state,
                    clock.elapsed().as_secs_f64()
                ),
                Ok(None) => println!("{}: nothing known", case.name),
                Err(e) => println!("{} {tol:e}: {e}", case.name),
            }
        }
    }
}
