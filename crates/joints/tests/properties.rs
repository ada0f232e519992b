//! All properties of all definitions.

use joints::conformance::{check_constraint, check_force};
use joints::{Constraint, Force, Visitor};
#[test]
fn probe() {
    struct A;
    impl Visitor for A {
        fn constraint<K: Constraint>(&mut self) { 
            let t = std::time::Instant::now();
            match check_constraint::<K>(2013) { Ok(()) => println!("ok {} {:?}", K::SPEC.common.name, t.elapsed()), Err(e) => println!("{e}") } }
        fn drive<K: Constraint>(&mut self) { println!("drive {}", K::SPEC.common.name) }
        fn force<K: Force>(&mut self) { 
            let t = std::time::Instant::now();
            match check_force::<K>(2013) { Ok(()) => println!("ok {} {:?}", K::SPEC.common.name, t.elapsed()), Err(e) => println!("{e}") } }
    }
    joints::plane_constraints(&mut A);
    joints::plane_forces(&mut A);
}
