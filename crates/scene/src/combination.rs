//! Linear combinations of reactions. A combination contains either components, such as `W3.N +
//! W4.N` or `2*A.Fx - B.T`, or whole wrenches, such as `W3 + W4`.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use joints::{LARGEST, is_usable};

use crate::nearest::{list, nearest};

/// The terms of a sum; there is at least one term.
#[derive(Clone, Debug, PartialEq)]
pub enum Combination {
    /// `Σ coefficient·component`: a scalar.
    Components(Vec<Term>),
    /// `Σ coefficient·wrench`: force and torque; the torque is about the reference point of the
    /// first joint or drive.
    Wrenches(Vec<WrenchTerm>),
}

/// One component of the reaction of a joint or drive, times a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// The factor; 1 if the text has no factor.
    pub coefficient: f64,
    /// Name of the joint or drive.
    pub reaction: String,
    /// Name of the component: `Fx`, `Fy`, `T`, or a named component, such as `N`.
    pub component: String,
}

/// The wrench of the reaction of a joint or drive, times a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct WrenchTerm {
    /// The factor; 1 if the text has no factor.
    pub coefficient: f64,
    /// Name of the joint or drive.
    pub reaction: String,
}

/// Reason why a text is not a valid combination.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problem}")]
pub struct CombinationError {
    /// The kind of error.
    pub problem: CombinationProblem,
    /// Position in the expression (bytes).
    pub span: Range<usize>,
}

/// Kind of error in a combination.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CombinationProblem {
    /// A term is missing.
    #[error("expected a term as `A`, `A.Fx` or `2*A.Fx`")]
    NoTerm,
    /// Two terms have no sign between them.
    #[error("expected `+` or `-` between terms, found `{found}`")]
    NoSign {
        /// The character found in place of a sign.
        found: char,
    },
    /// The sum mixes terms of both kinds: some terms are single components, and the other terms are
    /// reactions with all their components.
    #[error("`{text}` is {}; write all terms with a component, or none", mixed(.whole))]
    Mixed {
        /// Text of the term.
        text: String,
        /// Whether the term is a reaction with all its components.
        whole: bool,
    },
    /// A number and a term have no `*` between them.
    #[error("a factor is written with `*`: `{factor}*{term}`")]
    NoTimes {
        /// Text of the number.
        factor: String,
        /// Text of the term.
        term: String,
    },
    /// A joint or drive does not exist.
    #[error("there is no joint or drive `{name}`{}", suggestion(.nearest.as_deref()))]
    UnknownReaction {
        /// The unknown name.
        name: String,
        /// The most similar name.
        nearest: Option<String>,
    },
    /// A joint or drive is not active.
    #[error("`{name}` is not active, so there is no reaction")]
    Inactive {
        /// Name of the joint or drive.
        name: String,
    },
    /// The reaction does not have a component with this name.
    #[error("the reaction of `{reaction}` has no component `{component}`; it has {available}")]
    UnknownComponent {
        /// Name of the joint or drive.
        reaction: String,
        /// Name of the component.
        component: String,
        /// Components of the reaction.
        available: String,
    },
    /// A factor is too large.
    #[error("the factor `{text}` is not a finite number up to {LARGEST:e}")]
    NotFinite {
        /// Text of the factor.
        text: String,
    },
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

fn mixed(whole: &bool) -> &'static str {
    if *whole {
        "a whole reaction, but the first term is a component"
    } else {
        "a component, but the first term is a whole reaction"
    }
}

/// A joint or drive. If its definition is available, the components of the reaction are included.
pub(crate) struct ReactionNames<'a> {
    pub(crate) name: &'a str,
    pub(crate) components: Option<Vec<&'static str>>,
}

/// All joints and drives, which can be found by name.
pub(crate) struct Reactions<'a> {
    list: Vec<ReactionNames<'a>>,
    /// Indices by name; if a name is used twice, the index of the first.
    by_name: HashMap<&'a str, usize>,
    /// Length of the longest name (bytes).
    longest: usize,
    /// Names of joints and drives that are not active.
    inactive: HashSet<&'a str>,
}

impl<'a> Reactions<'a> {
    pub(crate) fn new(list: Vec<ReactionNames<'a>>) -> Self {
        let mut by_name = HashMap::with_capacity(list.len());
        for (at, reaction) in list.iter().enumerate() {
            by_name.entry(reaction.name).or_insert(at);
        }
        let longest = list.iter().map(|r| r.name.len()).max().unwrap_or(0);
        Self {
            list,
            by_name,
            longest,
            inactive: HashSet::new(),
        }
    }

    /// Adds the names of inactive joints and drives.
    pub(crate) fn without(mut self, inactive: impl Iterator<Item = &'a str>) -> Self {
        self.inactive.extend(inactive);
        self
    }

    /// Whether a name belongs to an inactive joint or drive.
    pub(crate) fn is_inactive(&self, name: &str) -> bool {
        self.inactive.contains(name)
    }

    /// Names of the joints and drives, in the order of the file.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'a str> + '_ {
        self.list.iter().map(|reaction| reaction.name)
    }

    /// The joint or drive with this name, if there is one.
    pub(crate) fn find(&self, name: &str) -> Option<&ReactionNames<'a>> {
        self.by_name.get(name).map(|&at| &self.list[at])
    }

    /// Finds the names of joints and drives at the start of a text, and returns the joint or drive
    /// with the longest of these names. A term must be able to end after the name.
    fn longest_at(&self, text: &str) -> Option<&ReactionNames<'a>> {
        starts(text, self.longest).find_map(|start| self.find(start))
    }

    /// Returns the longest name of an inactive joint or drive at the start of a text. A term must
    /// be able to end after the name.
    fn inactive_at<'t>(&self, text: &'t str) -> Option<&'t str> {
        let longest = self.inactive.iter().map(|name| name.len()).max()?;
        starts(text, longest).find(|start| self.is_inactive(start))
    }
}

/// Returns the initial parts of a text after which a term may end, with at most this length
/// (bytes). The longest part comes first.
fn starts(text: &str, longest: usize) -> impl Iterator<Item = &str> {
    let reach = text.floor_char_boundary(longest);
    let end = (reach == text.len()).then_some(reach);
    // The search includes one more character after the longest name.
    let ends = text[reach..]
        .chars()
        .next()
        .map_or(reach, |c| reach + c.len_utf8());
    let ends = text[..ends].char_indices().rev();
    let ends = ends.filter(|(_, c)| c.is_whitespace() || ['.', '+', '-'].contains(c));
    let ends = end.into_iter().chain(ends.map(|(at, _)| at));
    ends.map(|end| &text[..end])
}

/// Returns a term up to the next sign, including the blanks in its name. A name may contain a `-`
/// that does not follow a blank.
fn whole_term(text: &str) -> &str {
    let sign = |(at, c): (usize, char)| {
        c == '+' || (c == '-' && text[..at].ends_with(char::is_whitespace))
    };
    let end = text.char_indices().find(|&found| sign(found));
    text[..end.map_or(text.len(), |(at, _)| at)].trim_end()
}

/// Reads an expression.
pub(crate) fn parse(text: &str, reactions: &Reactions) -> Result<Combination, CombinationError> {
    let mut scanner = Scanner { text, at: 0 };
    scanner.skip_space();
    let sign = scanner.sign().unwrap_or(1.0);
    scanner.skip_space();
    let mut sum = Combination::of(scanner.term(sign, reactions)?);
    loop {
        scanner.skip_space();
        let Some(found) = scanner.rest().chars().next() else {
            return Ok(sum);
        };
        let sign = scanner.sign().ok_or_else(|| CombinationError {
            problem: CombinationProblem::NoSign { found },
            span: scanner.at..scanner.at + found.len_utf8(),
        })?;
        scanner.skip_space();
        let start = scanner.at;
        let term = scanner.term(sign, reactions)?;
        let span = start..scanner.at;
        sum.push(term).map_err(|whole| CombinationError {
            problem: CombinationProblem::Mixed {
                text: text[span.clone()].to_owned(),
                whole,
            },
            span,
        })?;
    }
}

/// A parsed term.
enum ParsedTerm {
    Component(Term),
    Wrench(WrenchTerm),
}

impl Combination {
    fn of(term: ParsedTerm) -> Self {
        match term {
            ParsedTerm::Component(term) => Self::Components(vec![term]),
            ParsedTerm::Wrench(term) => Self::Wrenches(vec![term]),
        }
    }

    /// Adds a term of the same kind. A term of the other kind is an error; the value of the error
    /// states whether this term is a whole wrench.
    fn push(&mut self, term: ParsedTerm) -> Result<(), bool> {
        match (self, term) {
            (Self::Components(terms), ParsedTerm::Component(term)) => terms.push(term),
            (Self::Wrenches(terms), ParsedTerm::Wrench(term)) => terms.push(term),
            (Self::Components(_), ParsedTerm::Wrench(_)) => return Err(true),
            (Self::Wrenches(_), ParsedTerm::Component(_)) => return Err(false),
        }
        Ok(())
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

    fn term(&mut self, sign: f64, all: &Reactions) -> Result<ParsedTerm, CombinationError> {
        let coefficient = sign * self.factor()?;
        let start = self.at;
        // Names may contain any characters, so the longest known name that fits is used.
        let Some(known) = all.longest_at(self.rest()) else {
            return Err(self.unknown(all));
        };
        let reaction = known.name.to_owned();
        self.at += known.name.len();
        if !self.rest().starts_with('.') {
            return Ok(ParsedTerm::Wrench(WrenchTerm {
                coefficient,
                reaction,
            }));
        }
        self.at += 1;
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let length = self.rest().find(|c| !word(c)).unwrap_or(self.rest().len());
        let component = &self.rest()[..length];
        self.at += length;
        if let Some(components) = &known.components
            && !components.contains(&component)
        {
            return Err(CombinationError {
                problem: CombinationProblem::UnknownComponent {
                    reaction,
                    component: component.to_owned(),
                    available: list(components.iter().copied()),
                },
                span: start..self.at,
            });
        }
        Ok(ParsedTerm::Component(Term {
            coefficient,
            reaction,
            component: component.to_owned(),
        }))
    }

    /// Reads a number before `*`, with its sign if there is one. Without a number, the result is 1.
    fn factor(&mut self) -> Result<f64, CombinationError> {
        let rest = self.rest();
        let in_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c) || c.is_whitespace();
        let end = rest.find(|c| !in_number(c)).unwrap_or(rest.len());
        let (before, after) = rest.split_at(end);
        if !after.starts_with('*') {
            return Ok(1.0);
        }
        let number = before.trim_end();
        let Ok(value) = number.parse::<f64>() else {
            return Ok(1.0);
        };
        if !is_usable(value) {
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

    /// Returns a number and the term after it, if only `*` is missing between them.
    fn factor_without_times(&self, all: &Reactions) -> Option<(&'a str, &'a str)> {
        let rest = self.rest();
        let in_number = |c: char| c.is_ascii_digit() || c == '.';
        let (number, after) = rest.split_at(rest.find(|c| !in_number(c))?);
        let term = after.trim_start();
        number.parse::<f64>().ok()?;
        all.longest_at(term)?;
        Some((number, term.split([' ', '+']).next().unwrap_or(term)))
    }

    /// The error for a term that starts with an unknown name.
    fn unknown(&self, all: &Reactions) -> CombinationError {
        let rest = self.rest();
        let end = |c: char| c.is_whitespace() || c == '+';
        let word = rest.split(end).next().unwrap_or(rest);
        let term = whole_term(rest);
        let (problem, token) = if word.is_empty() {
            (CombinationProblem::NoTerm, word)
        } else if let Some((factor, term)) = self.factor_without_times(all) {
            let (factor, term) = (factor.to_owned(), term.to_owned());
            (CombinationProblem::NoTimes { factor, term }, word)
        } else if let Some(name) = all.inactive_at(rest) {
            let name = name.to_owned();
            (CombinationProblem::Inactive { name }, term)
        } else {
            let name = term.rsplit_once('.').map_or(term, |(name, _)| name);
            let unknown = CombinationProblem::UnknownReaction {
                name: name.to_owned(),
                nearest: nearest(name, all.names()).map(str::to_owned),
            };
            (unknown, term)
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
        let names = ["W3", "W4", "W4-left", "a.b", "left wheel"].map(|name| ReactionNames {
            name,
            components: Some(vec!["Fx", "Fy", "N"]),
        });
        let names = Reactions::new(names.into()).without(["spare wheel"].into_iter());
        parse(text, &names)
            .map(|c| match c {
                Combination::Components(terms) => {
                    let term = |t: Term| (t.coefficient, format!("{}|{}", t.reaction, t.component));
                    terms.into_iter().map(term).collect()
                }
                Combination::Wrenches(terms) => {
                    let term = |t: WrenchTerm| (t.coefficient, t.reaction);
                    terms.into_iter().map(term).collect()
                }
            })
            .map_err(|e| format!("{:?}: {e}", e.span))
    }

    #[test]
    fn terms_are_read_with_signs_and_factors() {
        let terms = |terms: &[(f64, &str)]| -> Result<Vec<(f64, String)>, String> {
            Ok(terms.iter().map(|&(k, s)| (k, s.to_owned())).collect())
        };
        for (text, expected) in [
            ("W3.N + W4.N", terms(&[(1.0, "W3|N"), (1.0, "W4|N")])),
            (
                " -2*W4-left.N-0.5 * a.b.Fx+W4.Fy ",
                terms(&[(-2.0, "W4-left|N"), (-0.5, "a.b|Fx"), (1.0, "W4|Fy")]),
            ),
            ("W3+W4", terms(&[(1.0, "W3"), (1.0, "W4")])),
            ("W3", terms(&[(1.0, "W3")])),
            // The longest fitting name is used.
            (
                "-W3-W4-left - 2*a.b",
                terms(&[(-1.0, "W3"), (-1.0, "W4-left"), (-2.0, "a.b")]),
            ),
            ("W4-W3", terms(&[(1.0, "W4"), (-1.0, "W3")])),
            // A factor with its own sign.
            (
                "W3.N + -1*W4.N - -2e+1*W4.Fy",
                terms(&[(1.0, "W3|N"), (-1.0, "W4|N"), (20.0, "W4|Fy")]),
            ),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
    }

    #[test]
    fn faults_are_named_with_their_place() {
        for (text, expected) in [
            ("", "0..0: expected a term as `A`, `A.Fx` or `2*A.Fx`"),
            ("W3.N +", "6..6: expected a term as `A`, `A.Fx` or `2*A.Fx`"),
            (
                "W3.N W4.N",
                "5..6: expected `+` or `-` between terms, found `W`",
            ),
            (
                "W3 + 2*W4.N",
                "5..11: `2*W4.N` is a component, but the first term is a whole reaction; \
                 write all terms with a component, or none",
            ),
            (
                "W3.N - W4",
                "7..9: `W4` is a whole reaction, but the first term is a component; \
                 write all terms with a component, or none",
            ),
            (
                "W5+W4",
                "0..2: there is no joint or drive `W5`; did you mean `W3`?",
            ),
            (
                "W3*2",
                "0..4: there is no joint or drive `W3*2`; did you mean `W3`?",
            ),
            (
                "W3.N - 3 W4.N + W3.N",
                "7..8: a factor is written with `*`: `3*W4.N`",
            ),
            ("2.5W4", "0..5: a factor is written with `*`: `2.5*W4`"),
            (
                "W3.N + W5.N",
                "7..11: there is no joint or drive `W5`; did you mean `W3`?",
            ),
            (
                "W3.N - left whel.N + W4.N",
                "7..18: there is no joint or drive `left whel`; did you mean `left wheel`?",
            ),
            (
                "W3 + spare wheel",
                "5..16: `spare wheel` is not active, so there is no reaction",
            ),
            (
                "spare wheel.N - W3.N",
                "0..13: `spare wheel` is not active, so there is no reaction",
            ),
            (
                "W3.M",
                "0..4: the reaction of `W3` has no component `M`; it has `Fx`, `Fy`, `N`",
            ),
            (
                "1e999*W3.N",
                "0..5: the factor `1e999` is not a finite number up to 1e60",
            ),
        ] {
            assert_eq!(read(text), Err(expected.to_owned()), "{text}");
        }
    }
}
