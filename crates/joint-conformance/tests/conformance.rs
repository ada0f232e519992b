//! Tests all properties of all definitions, and tests that the harness detects errors.

mod mutants;

use joints::generated::{plane_constraints, plane_forces};
use joints::spec::Spec;
use joints::visitor::Visitor;
use joints::{Constraint, Force};
use pfaff_joint_conformance::check_all;

/// An arbitrary number, which is fixed so that failures can be reproduced.
const SEED: u64 = 2013;

#[test]
fn every_definition_has_every_property() {
    if let Err(failure) = check_all(SEED) {
        panic!("{failure}");
    }
}

/// Editors and `pfaff schema` show the description of each parameter.
#[test]
fn every_parameter_is_described() {
    #[derive(Default)]
    struct Specs(Vec<Spec>);
    impl Visitor for Specs {
        fn constraint<C: Constraint>(&mut self) {
            self.0.push(C::SPEC.common);
            C::visit_drives(self);
        }
        fn drive<C: Constraint>(&mut self) {
            self.0.push(C::SPEC.common);
        }
        fn force<F: Force>(&mut self) {
            self.0.push(F::SPEC.common);
        }
    }
    let mut specs = Specs::default();
    plane_constraints(&mut specs);
    plane_forces(&mut specs);
    assert!(specs.0.len() >= 19, "{}", specs.0.len());
    for spec in specs.0 {
        for parameter in spec.parameters {
            let (doc, name) = (parameter.doc, parameter.name);
            // The description must not repeat what the shape already states.
            let is_sentence = doc.ends_with('.') && doc.starts_with(char::is_uppercase);
            assert!(
                is_sentence && !doc.contains("(m"),
                "{}: `{name}`: `{doc}`",
                spec.name
            );
        }
    }
}
