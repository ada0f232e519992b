//! Judges outcomes; no other module makes this decision.

use crate::stress::Judgement;

use crate::stress::case::{Expected, Outcome};

/// Compares an outcome with the expectation. An error of NaN exceeds every bound.
///
/// ```
/// use lab::stress::Judgement;
/// use lab::stress::{Expected, Outcome, judge};
///
/// let right = Expected::answer(1e-9, "closed form");
/// assert_eq!(judge(&right, &Outcome::answer(2e-10, "")), Judgement::Right);
/// assert_eq!(judge(&right, &Outcome::answer(f64::NAN, "")), Judgement::SilentlyWrong);
/// assert_eq!(judge(&right, &Outcome::refused("too stiff")), Judgement::Limit);
/// ```
#[must_use]
pub fn judge(expected: &Expected, outcome: &Outcome) -> Judgement {
    match (expected, outcome) {
        (
            Expected::Answer { bound, .. } | Expected::AnswerOrRefusal { bound, .. },
            Outcome::Answer { error, .. },
        ) => {
            if error.abs() <= *bound {
                Judgement::Right
            } else {
                Judgement::SilentlyWrong
            }
        }
        (Expected::Answer { .. }, Outcome::Refused { .. }) => Judgement::Limit,
        (Expected::Refusal { .. }, Outcome::Answer { .. }) => Judgement::SilentlyWrong,
        (
            Expected::Refusal { parts } | Expected::AnswerOrRefusal { parts, .. },
            Outcome::Refused { text },
        ) => {
            if parts.iter().all(|part| text.contains(part.as_str())) {
                Judgement::Refused
            } else {
                Judgement::Misnamed
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn either() -> Expected {
        Expected::AnswerOrRefusal {
            bound: 1e-6,
            source: "documented limit",
            parts: vec!["spring".into(), "not resolved".into()],
        }
    }

    #[test]
    fn an_answer_is_right_up_to_its_bound() {
        let right = Expected::answer(0.0, "exact");
        assert_eq!(judge(&right, &Outcome::answer(0.0, "")), Judgement::Right);
        assert_eq!(judge(&right, &Outcome::answer(-0.0, "")), Judgement::Right);
        for error in [f64::MIN_POSITIVE, f64::INFINITY, f64::NAN, -1.0] {
            let found = judge(&right, &Outcome::answer(error, ""));
            assert_eq!(found, Judgement::SilentlyWrong, "{error}");
        }
        let any = Expected::answer(f64::NAN, "no bound at all");
        assert_eq!(
            judge(&any, &Outcome::answer(0.0, "")),
            Judgement::SilentlyWrong
        );
    }

    #[test]
    fn a_refusal_has_to_say_everything() {
        let right = Expected::refusal(&["rod", "massless"]);
        let judged = |text: &str| judge(&right, &Outcome::refused(text));
        assert_eq!(judged("body `rod`: massless motion"), Judgement::Refused);
        assert_eq!(judged("massless motion"), Judgement::Misnamed);
        assert_eq!(
            judge(&right, &Outcome::answer(0.0, "")),
            Judgement::SilentlyWrong
        );
    }

    #[test]
    fn a_refusal_of_what_has_an_answer_is_a_limit() {
        let right = Expected::answer(1.0, "closed form");
        let found = judge(&right, &Outcome::refused("singular"));
        assert_eq!(found, Judgement::Limit);
        assert!(!found.passes());
    }

    #[test]
    fn stated_limits_may_be_met_either_way_but_not_by_a_wrong_answer() {
        let judged = |outcome: Outcome| judge(&either(), &outcome);
        assert_eq!(judged(Outcome::answer(1e-7, "")), Judgement::Right);
        assert_eq!(judged(Outcome::answer(1e-5, "")), Judgement::SilentlyWrong);
        let said = "the spring `k` oscillates, which is not resolved";
        assert_eq!(judged(Outcome::refused(said)), Judgement::Refused);
        assert_eq!(judged(Outcome::refused("no")), Judgement::Misnamed);
    }
}
