//! Linear combinations of reaction components, as `W3.N + W4.N` or `2*A.Fx - B.T`.

use std::ops::Range;

use crate::nearest::{list, nearest};

/// `Σ coefficient·component`
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Combination {
    /// Its terms, at least one.
    pub terms: Vec<Term>,
}

/// One component of the reaction of a joint or drive, times a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// The factor, 1 where none is written.
    pub coefficient: f64,
    /// Name of the joint or drive.
    pub reaction: String,
    /// `Fx`, `Fy`, `T`, or a named component, as `N`.
    pub component: String,
}

/// Why a text is no combination.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problem}")]
pub struct CombinationError {
    /// What is wrong.
    pub problem: CombinationProblem,
    /// Bytes of the expression.
    pub span: Range<usize>,
}

/// What is wrong with a combination.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CombinationProblem {
    /// A term is missing.
    #[error("expected a term as `A.Fx` or `2*A.Fx`")]
    NoTerm,
    /// Two terms without a sign between them.
    #[error("expected `+` or `-` between terms, found `{found}`")]
    NoSign {
        /// What stands there.
        found: char,
    },
    /// A name without a component.
    #[error("`{text}` names no component: write `name.component`")]
    NoComponent {
        /// What stands there.
        text: String,
    },
    /// A joint or drive that does not exist.
    #[error("there is no joint or drive `{name}`{}", suggestion(.nearest.as_deref()))]
    UnknownReaction {
        /// The name.
        name: String,
        /// The nearest one.
        nearest: Option<String>,
    },
    /// A component that the reaction does not have.
    #[error("the reaction of `{reaction}` has no component `{component}`; it has {available}")]
    UnknownComponent {
        /// The joint or drive.
        reaction: String,
        /// The component.
        component: String,
        /// What it has.
        available: String,
    },
    /// A factor that is too large.
    #[error("the factor `{text}` is not a finite number")]
    NotFinite {
        /// The factor.
        text: String,
    },
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

/// A joint or drive with the components of its reaction, if its definition is known.
pub(crate) struct ReactionNames<'a> {
    pub(crate) name: &'a str,
    pub(crate) components: Option<Vec<&'static str>>,
}

/// Reads an expression.
pub(crate) fn parse(
    text: &str,
    reactions: &[ReactionNames],
) -> Result<Combination, CombinationError> {
    let mut scanner = Scanner { text, at: 0 };
    let mut terms = Vec::new();
    scanner.skip_space();
    let mut sign = scanner.sign().unwrap_or(1.0);
    loop {
        scanner.skip_space();
        terms.push(scanner.term(sign, reactions)?);
        scanner.skip_space();
        let Some(found) = scanner.rest().chars().next() else {
            return Ok(Combination { terms });
        };
        sign = scanner.sign().ok_or_else(|| CombinationError {
            problem: CombinationProblem::NoSign { found },
            span: scanner.at..scanner.at + found.len_utf8(),
        })?;
    }
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    fn sign(&mut self) -> Option<f64> {
        let sign = match self.rest().as_bytes().first()? {
            b'+' => 1.0,
            b'-' => -1.0,
            _ => return None,
        };
        self.at += 1;
        Some(sign)
    }

    fn term(&mut self, sign: f64, all: &[ReactionNames]) -> Result<Term, CombinationError> {
        let factor = self.factor()?;
        let start = self.at;
        let fault = |problem, end| CombinationError {
            problem,
            span: start..end,
        };
        // Names may contain anything, so the longest known one that fits is meant.
        let known = all
            .iter()
            .filter(|r| {
                let rest = self.rest().strip_prefix(r.name);
                rest.is_some_and(|rest| rest.starts_with('.'))
            })
            .max_by_key(|r| r.name.len());
        let Some(known) = known else {
            return Err(self.unknown(all));
        };
        self.at += known.name.len() + 1;
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let length = self.rest().find(|c| !word(c)).unwrap_or(self.rest().len());
        let component = &self.rest()[..length];
        self.at += length;
        if let Some(components) = &known.components
            && !components.contains(&component)
        {
            let problem = CombinationProblem::UnknownComponent {
                reaction: known.name.to_owned(),
                component: component.to_owned(),
                available: list(components.iter().copied()),
            };
            return Err(fault(problem, self.at));
        }
        Ok(Term {
            coefficient: sign * factor,
            reaction: known.name.to_owned(),
            component: component.to_owned(),
        })
    }

    /// A number before `*`, or 1.
    fn factor(&mut self) -> Result<f64, CombinationError> {
        let Some((before, _)) = self.rest().split_once('*') else {
            return Ok(1.0);
        };
        let number = before.trim_end();
        if number.is_empty() || !number.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return Ok(1.0);
        }
        let Ok(value) = number.parse::<f64>() else {
            return Ok(1.0);
        };
        if !value.is_finite() {
            return Err(CombinationError {
                problem: CombinationProblem::NotFinite {
                    text: number.to_owned(),
                },
                span: self.at..self.at + number.len(),
            });
        }
        self.at += before.len() + 1;
        self.skip_space();
        Ok(value)
    }

    /// What to say of a term that begins with no known name.
    fn unknown(&self, all: &[ReactionNames]) -> CombinationError {
        let rest = self.rest();
        let token = rest.split(char::is_whitespace).next().unwrap_or(rest);
        let problem = match token.rsplit_once('.') {
            _ if token.is_empty() => CombinationProblem::NoTerm,
            None => CombinationProblem::NoComponent {
                text: token.to_owned(),
            },
            Some((name, _)) => CombinationProblem::UnknownReaction {
                name: name.to_owned(),
                nearest: nearest(name, all.iter().map(|r| r.name)).map(str::to_owned),
            },
        };
        CombinationError {
            problem,
            span: self.at..self.at + token.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<(f64, String)>, String> {
        let names = ["W3", "W4", "W4-left", "a.b"].map(|name| ReactionNames {
            name,
            components: Some(vec!["Fx", "Fy", "N"]),
        });
        parse(text, &names)
            .map(|c| {
                let term = |t: Term| (t.coefficient, format!("{}|{}", t.reaction, t.component));
                c.terms.into_iter().map(term).collect()
            })
            .map_err(|e| format!("{:?}: {e}", e.span))
    }

    #[test]
    fn terms_are_read_with_signs_and_factors() {
        let term = |k: f64, s: &str| (k, s.to_owned());
        assert_eq!(
            read("W3.N + W4.N"),
            Ok(vec![term(1.0, "W3|N"), term(1.0, "W4|N")])
        );
        assert_eq!(
            read(" -2*W4-left.N-0.5 * a.b.Fx+W4.Fy "),
            Ok(vec![
                term(-2.0, "W4-left|N"),
                term(-0.5, "a.b|Fx"),
                term(1.0, "W4|Fy")
            ])
        );
    }

    #[test]
    fn faults_are_named_with_their_place() {
        for (text, expected) in [
            ("", "0..0: expected a term as `A.Fx` or `2*A.Fx`"),
            ("W3.N +", "6..6: expected a term as `A.Fx` or `2*A.Fx`"),
            (
                "W3.N W4.N",
                "5..6: expected `+` or `-` between terms, found `W`",
            ),
            (
                "W3",
                "0..2: `W3` names no component: write `name.component`",
            ),
            (
                "W3.N + W5.N",
                "7..11: there is no joint or drive `W5`; did you mean `W3`?",
            ),
            (
                "W3.M",
                "0..4: the reaction of `W3` has no component `M`; it has `Fx`, `Fy`, `N`",
            ),
            (
                "1e999*W3.N",
                "0..5: the factor `1e999` is not a finite number",
            ),
        ] {
            assert_eq!(read(text), Err(expected.to_owned()), "{text}");
        }
    }
}
