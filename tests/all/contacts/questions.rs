//! Other questions about scenes with contacts: equilibria, linearised motions, and choices.

use model::System;
use pfaff::StudyError;
use pfaff::contact_fault::ContactFault;
use pfaff::dynamics::equilibrium::EquilibriumOptions;
use pfaff::dynamics::linearise::LineariseOptions;
use pfaff::solvability::{Choice, ConditionKind, ContactCondition, NormWeights};

use super::friction::ladder;
use super::supports::table;
use super::{id_of, study};

/// Returns the reason why a result is refused because of contacts; `None` if there is a result.
#[track_caller]
fn fault<T>(found: Result<T, StudyError>) -> Option<ContactFault> {
    match found {
        Ok(_) => None,
        Err(StudyError::Contacts { fault, .. }) => Some(fault),
        Err(e) => panic!("{e}"),
    }
}

fn rest(text: &str) -> Option<ContactFault> {
    fault(study(text).equilibrium(&EquilibriumOptions::default()))
}

/// A load above the table leaves it at rest; a load beyond the edge AB lifts the legs C and D.
#[test]
fn a_table_that_tips_has_no_equilibrium() {
    assert_eq!(rest(&table([0.2, 0.1])), None);
    assert_eq!(rest(&table([0.3, 0.4])), None);
    let opens = ContactFault::Opens(vec!["C".to_owned(), "D".to_owned()]);
    assert_eq!(rest(&table([0.3, 0.5])), Some(opens));
}

/// A man at 0.9 of a ladder at 65° to a smooth wall needs the friction 0.9/tan 65°.
#[test]
fn a_ladder_that_slips_has_no_equilibrium() {
    let least = 0.9 / 65.0_f64.to_radians().tan();
    assert_eq!(rest(&ladder(0.9, 1.001 * least, None)), None);
    let slips = ContactFault::Slips(vec!["floor tread".to_owned()]);
    assert_eq!(rest(&ladder(0.9, 0.999 * least, None)), Some(slips));
}

/// A stone below the hook pulls on its rope; above the hook it would have to push.
#[test]
fn small_motions_about_a_slack_rope_are_refused() {
    let stone = |y: f64| {
        format!(
            "scene = {{ name = \"stone\", space = \"plane\", gravity = [0.0, -9.81] }}\n\
             body = [{{ name = \"stone\", mass = 0.7, inertia = 0.1, position = [0.0, {y:?}] }}]\n\
             joint = [{{ name = \"rope\", type = \"distance\", bodies = [\"ground\", \"stone\"], at = [[0.0, 0.0], [0.0, {y:?}]], \
             one_sided = \"pulls\" }}]\n"
        )
    };
    let linear = |y: f64| fault(study(&stone(y)).linearise(0.0, &LineariseOptions::default()));
    assert_eq!(linear(-1.5), None);
    let opens = ContactFault::Opens(vec!["rope".to_owned()]);
    assert_eq!(linear(1.5), Some(opens));
}

/// With the load above the edge AB, the legs carry 88.29, 29.43, 0 and 0 N and any multiple of
/// (1, −1, 1, −1). The least norm subtracts 14.715 N of it, so that C pulls.
#[test]
fn a_choice_that_pulls_is_named() {
    let study = study(&table([0.3, 0.4]));
    let start = study.analyse(0.0, None).expect("small");
    let of = |choice: &Choice| {
        let distribution = start.distribution(choice).expect("decided");
        start.violated(&distribution).expect("clear")
    };
    let leg = |name: &str| ContactCondition {
        joint: id_of(&start, name),
        kind: ConditionKind::Presses,
    };
    let least = Choice::MinimumNorm(NormWeights::NEWTON_METRE);
    assert_eq!(of(&least), [leg("C")]);
    // Without the row of C or of D the sharing is the permitted one.
    let row = |name: &str| {
        let id = id_of(&start, name);
        study.prepared.mechanism.layout().groups[id.0].rows.row(0)
    };
    for name in ["C", "D"] {
        assert_eq!(of(&Choice::Elimination(vec![row(name)])), []);
    }
    assert_eq!(of(&Choice::Elimination(vec![row("A")])), [leg("C")]);
}
