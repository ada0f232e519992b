//! Checks dependencies and sentences. The sets of rows must be minimal and dependent, and
//! coefficients and forces must agree with exact arithmetic. Sentences must contain the names and
//! ratios of the rows, and only correct sums.

use num_bigint::BigInt;
use serde_json::Value;

use super::expected::{Expected, ExpectedReaction};
use super::findings::{Findings, Kind, list, rows, share_of_free};
use super::text;
use super::truth::{Reaction, Truth, largest};
use super::wrench::Owner;

/// Numbers in sentences have four digits.
const FOUR_DIGITS: f64 = 6e-4;

/// Compares all dependencies and sentences of a decided document.
pub fn examine(truth: &Truth, right: &Expected, answer: &Value, findings: &mut Findings) {
    let redundancy = truth.redundancy();
    let dependencies = list(&answer["dependencies"]);
    if dependencies.len() != redundancy {
        let text = format!(
            "{} dependencies, redundancy {redundancy}",
            dependencies.len()
        );
        findings.note(Kind::Sentence, text);
    }
    for (place, dependency) in dependencies.iter().enumerate() {
        let own = rows(&dependency["rows"]);
        match truth.circuit(&own) {
            Some(circuit) => {
                let dependency = Dependency {
                    truth,
                    place,
                    rows: &own,
                    circuit: &circuit,
                    answer: dependency,
                };
                dependency.coefficients(findings);
                dependency.forces(answer, findings);
                dependency.sentence(findings);
            }
            None => {
                let text = format!(
                    "the rows {} are not a minimal dependent set",
                    dependency["rows"]
                );
                findings.note(Kind::Sentence, text);
            }
        }
    }
    mixing(truth, answer, findings);
    for right in &right.reactions {
        let mut reactions = list(&answer["reactions"]).iter();
        if let Some(reaction) = reactions.find(|r| r["name"] == right.name.as_str())
            && let Some(text) = reaction["explanation"].as_str()
        {
            explanation(truth, right, reaction, text, findings);
        }
    }
}

/// Compares only sets of rows. Each set must be minimal and dependent, and the number of sets must
/// equal the redundancy.
pub fn circuits(truth: &Truth, answer: &Value, findings: &mut Findings) {
    let dependencies = list(&answer["dependencies"]);
    // Dependencies that are undecided within the tolerance are not compared.
    let open = findings.0.iter().any(|f| f.kind == Kind::Undecided);
    if dependencies.len() != truth.redundancy() && !open {
        let text = format!(
            "{} dependencies, redundancy {}",
            dependencies.len(),
            truth.redundancy()
        );
        findings.note(Kind::Sentence, text);
    }
    for dependency in dependencies {
        if truth.circuit(&rows(&dependency["rows"])).is_none() {
            let text = format!(
                "the rows {} are not a minimal dependent set",
                dependency["rows"]
            );
            findings.note(Kind::Sentence, text);
        }
    }
    if !open {
        mixing(truth, answer, findings);
    }
}

/// A correct dependency.
struct Dependency<'a> {
    truth: &'a Truth,
    place: usize,
    rows: &'a [usize],
    circuit: &'a [BigInt],
    answer: &'a Value,
}

impl Dependency<'_> {
    fn note(&self, findings: &mut Findings, text: String) {
        let of = format!("dependency of rows {}: {text}", self.answer["rows"]);
        findings.note(Kind::Sentence, of);
    }

    fn load(&self, findings: &mut Findings, text: String) {
        let of = format!("dependency of rows {}: {text}", self.answer["rows"]);
        findings.note(Kind::Load, of);
    }

    fn right(&self) -> Vec<f64> {
        self.truth.coefficients(self.rows, self.circuit)
    }

    fn coefficients(&self, findings: &mut Findings) {
        let answer = list(&self.answer["coefficients"]).iter();
        let answer: Vec<f64> = answer.map(|x| x.as_f64().unwrap_or(f64::NAN)).collect();
        if !are_proportional(&answer, &self.right(), self.truth.rounding) {
            let text = format!("coefficients {answer:?} are {:?}", self.right());
            self.note(findings, text);
        }
    }

    /// Returns the joints and drives of the dependency without repetition, in the order of the
    /// file.
    fn owners(&self) -> Vec<Owner> {
        let owners = self.truth.elements.iter().map(|e| e.owner);
        let has = |owner: &Owner| {
            self.rows
                .iter()
                .any(|&i| self.truth.rows[i].owner == *owner)
        };
        owners.filter(has).collect()
    }

    fn name(&self, owner: Owner) -> &str {
        &self.truth.element(owner).name
    }

    /// Returns the load of a joint, if its reference point is in the drawing.
    fn carried(&self, owner: Owner) -> Option<Reaction> {
        self.truth.carried(owner, self.rows, self.circuit)
    }

    fn rounded(&self, carried: &Reaction) -> Vec<f64> {
        self.truth.rounded(carried, &largest(self.circuit))
    }

    /// Compares the forces of the joints in the dependency, which may be drawn in a picture.
    fn forces(&self, document: &Value, findings: &mut Findings) {
        let (mut answer, mut right) = (Vec::new(), Vec::new());
        for owner in self.owners() {
            let name = self.name(owner);
            let mut reactions = list(&document["reactions"]).iter();
            let reaction = reactions.find(|r| r["name"] == name);
            let directions = reaction.map_or(&[][..], |r| list(&r["free_directions"]));
            let mut own = directions.iter();
            let Some(found) = own.find(|d| d["dependency"] == self.place) else {
                let text = format!("`{name}` is not answer what it carries");
                self.load(findings, text);
                return;
            };
            let number = |x: &Value| x.as_f64().unwrap_or(f64::NAN);
            let Some(carried) = self.carried(owner) else {
                continue;
            };
            let numbers = [&found["force"][0], &found["force"][1], &found["torque"]].map(number);
            for (k, answer) in numbers.into_iter().enumerate() {
                if answer != 0.0 && self.truth.is_zero(&carried, k) {
                    let axis = self.truth.components[k].name;
                    self.load(
                        findings,
                        format!("`{name}`.{axis} is answer as {answer:e}, is zero"),
                    );
                }
            }
            answer.extend(numbers);
            right.extend(self.rounded(&carried));
        }
        // The rounding errors of moments are proportional to the forces times the lever arms of the
        // scene.
        if !are_proportional(&answer, &right, 1e2 * self.truth.rounding) {
            self.load(
                findings,
                format!("forces {answer:?} are {right:?} up to a factor"),
            );
        }
    }

    fn sentence(&self, findings: &mut Findings) {
        let text = self.answer["text"].as_str().unwrap_or_default();
        let owners = self.owners();
        let joints: Vec<&str> = owners.iter().map(|&owner| self.name(owner)).collect();
        let mut named = list(&self.answer["joints"])
            .iter()
            .filter_map(Value::as_str);
        if joints.len() != named.clone().count() || !named.all(|n| joints.contains(&n)) {
            self.note(
                findings,
                format!("joints {} are {joints:?}", self.answer["joints"]),
            );
        }
        let sides = owners
            .iter()
            .flat_map(|&owner| &self.truth.element(owner).sides);
        let bodies: Vec<String> = sides.map(|side| text::name(*side)).collect();
        for quoted in text.split('`').skip(1).step_by(2) {
            // The text is a name, or terms such as `0.5*name.Fx`.
            let mut terms = quoted
                .split([' ', '*'])
                .filter(|t| t.parse::<f64>().is_err());
            let is_known = |term: &str| {
                let of = term.rsplit_once('.').map_or(term, |(name, _)| name);
                matches!(term, "+" | "-")
                    || joints.contains(&of)
                    || bodies.iter().any(|known| known == of)
            };
            if !terms.all(is_known) {
                self.note(findings, format!("`{quoted}` takes no part: {text}"));
            }
        }
        if let Some((_, rest)) = text.split_once(" in the ratio ") {
            let (printed, expected) = (ratio(rest), self.right());
            let sizes = printed.iter().zip(&expected).all(|(a, b)| {
                let (first, other) = (printed[0] / expected[0], a / b);
                (other / first - 1.0).abs() <= 4.0 * FOUR_DIGITS
            });
            if printed.len() != expected.len() || !sizes {
                self.note(findings, format!("the ratio is {expected:?}: {text}"));
            }
        }
        self.told_loads(text, &owners, findings);
        let carried = owners.iter().map(|&owner| self.carried(owner));
        let carried: Option<Vec<Reaction>> = carried.collect();
        let is_known = carried.is_some();
        let mut loads = carried.iter().flatten();
        let pushes = loads.any(|w| (0..3).any(|k| !w.is_zero(k)));
        if is_known && pushes && text.contains(" from turning") {
            self.note(findings, format!("they push as well: {text}"));
        }
        if is_known && !pushes && (text.contains("along the same line")) {
            self.note(findings, format!("they do not push: {text}"));
        }
    }
}

impl Dependency<'_> {
    /// Compares the loads in a sentence, "`a.Fx` = 1 N and `b.N` = −0.5 N cancel", and the
    /// combination of two components that these loads do not change.
    fn told_loads(&self, text: &str, owners: &[Owner], findings: &mut Findings) {
        let told = told(text);
        if told.is_empty() {
            return;
        }
        let (mut answer, mut right) = (Vec::new(), Vec::new());
        let (mut signs, mut blades) = (Vec::new(), Vec::new());
        for &owner in owners {
            let name = self.name(owner);
            let Some(carried) = self.carried(owner) else {
                return;
            };
            let numbers = self.rounded(&carried);
            let own = |axis: &str| {
                let mut own = told
                    .iter()
                    .filter(|(of, component, _)| *of == name && *component == axis);
                own.next().map(|(.., value)| *value)
            };
            // For a knife edge, the multiplier of its row is the force along the normal.
            if let Some(value) = own("N") {
                blades.push(right.len());
                answer.push(value.abs());
                right.push(numbers[0].hypot(numbers[1]));
                let at = self
                    .rows
                    .iter()
                    .position(|&i| self.truth.rows[i].owner == owner);
                signs.extend(at.map(|at| value * self.right()[at]));
                continue;
            }
            // The load of a drive is a force or a torque.
            if let Some(value) = own("drive") {
                blades.push(right.len());
                answer.push(value.abs());
                right.push(numbers.into_iter().fold(0.0, f64::hypot));
                continue;
            }
            let axes = self.truth.components.iter();
            answer.extend(axes.map(|axis| own(axis.name).unwrap_or(0.0)));
            right.extend(numbers);
        }
        let is_one_sign = signs.windows(2).all(|pair| pair[0] * pair[1] > 0.0);
        // For a knife edge and a drive, only the absolute value is known here. In addition, the
        // signs of all loads may be opposite.
        let mut other = right.clone();
        blades.iter().for_each(|&at| other[at] *= -1.0);
        let told_right = [&right, &other]
            .iter()
            .any(|right| are_proportional(&answer, right, 4.0 * FOUR_DIGITS));
        if !told_right || !is_one_sign {
            let text = format!("the loads are {right:?} up to a factor: {text}");
            self.note(findings, text);
        }
        // In the combination `a.Fx - 0.5*b.Fy` the loads of both components cancel.
        let combination = text.split('`').skip(1).step_by(2).find(|q| q.contains(' '));
        let terms = combination.map(|q| q.splitn(3, ' ').collect::<Vec<_>>());
        if let Some([first, sign, second]) = terms.as_deref() {
            let (weight, second) = second.split_once('*').unwrap_or(("1", second));
            let load = |term: &str| {
                let mut same = told.iter().filter(|(of, c, _)| format!("{of}.{c}") == term);
                same.next().map_or(f64::NAN, |(.., value)| *value)
            };
            let weight: f64 = weight.parse().unwrap_or(f64::NAN);
            let signed = if *sign == "-" { -weight } else { weight };
            let left = load(first) + signed * load(second);
            if left.is_nan() || left.abs() > 4.0 * FOUR_DIGITS * load(first).abs() {
                self.note(findings, format!("the loads do not cancel in it: {text}"));
            }
            let of = |term: &'_ str| {
                let (name, component) = term.rsplit_once('.')?;
                let mut own = owners.iter();
                let owner = own.find(|&&owner| self.name(owner) == name)?;
                Some((*owner, component.to_owned()))
            };
            let pair = of(first).zip(of(second));
            let is_unique = pair.and_then(|((i, c), (j, d))| {
                let circuit = (self.rows, self.circuit);
                self.truth.pair_is_unique(circuit, [(i, &c), (j, &d)])
            });
            if text.contains("` is determined") && is_unique == Some(false) {
                self.note(findings, format!("it is not determined: {text}"));
            }
            if text.contains("` depends on other reactions") && is_unique == Some(true) {
                self.note(findings, format!("it is determined: {text}"));
            }
        }
    }
}

/// Returns the loads of a sentence: joint, component, value.
fn told<'t>(text: &'t str) -> Vec<(&'t str, &'t str, f64)> {
    let parts: Vec<&str> = text.split('`').collect();
    let quoted = parts.iter().zip(parts.iter().skip(1)).skip(1).step_by(2);
    let load = |(quoted, behind): (&&'t str, &&'t str)| {
        let number = behind.strip_prefix(" = ")?.split(' ').next()?;
        let (name, component) = quoted.rsplit_once('.')?;
        Some((name, component, number.replace('−', "-").parse().ok()?))
    };
    quoted.filter_map(load).collect()
}

/// Whether one list is a multiple of the other list, with zeros at the same positions.
fn are_proportional(answer: &[f64], right: &[f64], rounding: f64) -> bool {
    let Some(at) = (0..right.len()).max_by(|&a, &b| right[a].abs().total_cmp(&right[b].abs()))
    else {
        return answer.is_empty();
    };
    if answer.len() != right.len() || right[at] == 0.0 {
        return answer.len() == right.len() && answer.iter().all(|x| *x == 0.0);
    }
    let factor = answer[at] / right[at];
    let off = answer
        .iter()
        .zip(right)
        .map(|(a, b)| (a - factor * b).abs());
    factor != 0.0 && off.fold(0.0, f64::max) <= rounding * answer[at].abs()
}

/// Returns the numbers of "1 : −0.5 : 0.25 cancel out", with or without units.
fn ratio(text: &str) -> Vec<f64> {
    let mut numbers = Vec::new();
    for part in text.split(" : ") {
        let number = part.trim_start().split([' ', ')', ',', ';']).next();
        let number = number.unwrap_or_default().replace('−', "-");
        numbers.push(number.parse().unwrap_or(f64::NAN));
    }
    numbers
}

/// Compares the groups of joints that share loads. A group is a union of components of the
/// circuits, is listed once, and has the correct redundancy.
fn mixing(truth: &Truth, answer: &Value, findings: &mut Findings) {
    let mut open = truth.components_of_circuits();
    for mixing in list(&answer["mixing"]) {
        let own = rows(&mixing["rows"]);
        let mut covered = 0;
        open.retain(|component| {
            let is_in = component.iter().all(|i| own.contains(i));
            covered += if is_in { component.len() } else { 0 };
            !is_in
        });
        let redundancy = own.len() - truth.rank_of(&own);
        if covered != own.len() || mixing["redundancy"] != redundancy {
            let text = format!("rows {} share loads: {}", mixing["rows"], mixing["text"]);
            findings.note(Kind::Sentence, text);
        }
        let mut names: Vec<&str> = own.iter().map(|&i| truth.name_of(i)).collect();
        names.sort_unstable();
        names.dedup();
        let mut answer: Vec<&str> = list(&mixing["reactions"])
            .iter()
            .filter_map(Value::as_str)
            .collect();
        answer.sort_unstable();
        let text = mixing["text"].as_str().unwrap_or_default();
        let quoted: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
        if names != answer
            || !names.iter().all(|name| quoted.contains(name))
            || quoted.len() != names.len()
        {
            findings.note(Kind::Sentence, format!("{names:?} share loads: {text}"));
        }
    }
    if !open.is_empty() {
        findings.note(
            Kind::Sentence,
            format!("no text states that rows {open:?} (from 0) share loads"),
        );
    }
}

/// Compares the sentence "the reaction of `a` is not determined: it shares loads with `b` and `c`;
/// only Fx and 0.6·Fx + 0.8·Fy are determined".
fn explanation(
    truth: &Truth,
    right: &ExpectedReaction,
    answer: &Value,
    text: &str,
    findings: &mut Findings,
) {
    let mut wrong = |why: &str| findings.note(Kind::Sentence, format!("{why}: {text}"));
    if right.is_unique.is_unique() {
        wrong("is unique");
    }
    let own = right.own_rows();
    let touching = truth
        .components_of_circuits()
        .into_iter()
        .filter(|c| own.iter().any(|i| c.contains(i)));
    let mut others: Vec<&str> = touching.flatten().map(|i| truth.name_of(i)).collect();
    others.sort_unstable();
    others.dedup();
    let quoted: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
    let mut sorted = quoted.clone();
    sorted.sort_unstable();
    if sorted != others {
        wrong(&format!("{others:?} share loads"));
    }
    let live = right.carried - right.free;
    if text.contains("no part of it is determined") && live > 0 {
        wrong("something is determined");
    }
    if text.contains("the determined part of it is undecided") {
        findings.note(Kind::Undecided, text.to_owned());
        return;
    }
    // If only components that are always zero are determined, the sentence lists these components.
    let listed = text.rsplit_once("; only ").map(|(_, listed)| listed);
    let is_or_are = [" is determined", " are determined"];
    let determined = listed.and_then(|listed| {
        let before = |verb| listed.split_once(verb).map(|(determined, _)| determined);
        is_or_are.into_iter().find_map(before)
    });
    let Some(determined) = determined else {
        return;
    };
    let components = list(&answer["components"])
        .iter()
        .filter_map(|c| c["name"].as_str());
    let components: Vec<&str> = components.collect();
    let all: Vec<&str> = determined
        .split(", ")
        .flat_map(|part| part.split(" and "))
        .collect();
    // Directions along which the reaction is always zero may also be listed.
    if all.len() < live || all.len() > components.len() - right.free {
        wrong(&format!("{live} directions are determined"));
    }
    let free = right.wrench.as_ref().map_or(&[][..], |w| &w.free);
    let axis = |name: &&str| truth.components.iter().position(|axis| axis.name == *name);
    let axes: Vec<usize> = components.iter().filter_map(axis).collect();
    for combination in all {
        let Some(direction) = terms(combination, &components) else {
            wrong("cannot be read");
            return;
        };
        let share = share_of_free(free, &axes, &direction, truth.rounding);
        if share.is_some_and(|share| share > 2.0 * FOUR_DIGITS) {
            wrong("is not determined");
        }
    }
}

/// Parses "0.6·Fx − 0.8·Fy" as coefficients of these components.
fn terms(text: &str, components: &[&str]) -> Option<Vec<f64>> {
    let mut direction = vec![0.0; components.len()];
    let signed = text.replace(" − ", " + −");
    for term in signed.split(" + ") {
        let (sign, term) = match term.strip_prefix('−') {
            Some(rest) => (-1.0, rest),
            None => (1.0, term),
        };
        let (factor, name) = match term.split_once('·') {
            Some((factor, name)) => (factor.replace('−', "-").parse().ok()?, name),
            None => (1.0, term),
        };
        direction[components.iter().position(|c| *c == name)?] += sign * factor;
    }
    Some(direction)
}
