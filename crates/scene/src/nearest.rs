//! Suggests the name that was probably intended.

/// Longer names are not compared, because the computing time is proportional to the square of the
/// length.
const LONGEST: usize = 80;

/// Names in other programs and books, each with the name used here. The book contains this list.
/// These names are used only for suggestions; a name that is not a candidate is skipped.
pub const ELSEWHERE: &[(&str, &str)] = &[
    ("pin", "revolute"),
    ("hinge", "revolute"),
    ("pivot", "revolute"),
    ("rotational", "revolute"),
    ("continuous", "revolute"),
    ("prismatic", "translational"),
    ("ball", "spherical"),
    ("ball-joint", "spherical"),
    ("ball joint", "spherical"),
    ("ball-and-socket", "spherical"),
    ("socket", "spherical"),
    ("sphere", "spherical"),
    ("cardan", "universal"),
    ("hooke", "universal"),
    ("u-joint", "universal"),
    ("gimbal", "universal"),
    ("cylinder", "cylindrical"),
    ("cylinder", "distance"),
    ("sleeve", "cylindrical"),
    ("gear", "mesh"),
    ("belt", "coupling"),
    ("chain", "coupling"),
    ("mimic", "coupling"),
    ("slider", "translational"),
    ("slide", "translational"),
    ("slot", "pin-in-slot"),
    ("pin-in-slot", "point-on-line"),
    ("weld", "fixed"),
    ("rigid", "fixed"),
    ("clamp", "fixed"),
    ("rod", "distance"),
    ("link", "distance"),
    ("bar", "distance"),
    ("wheel", "knife-edge"),
    ("skate", "knife-edge"),
    ("mount", "bushing"),
    ("spring", "spring-damper"),
    ("damper", "spring-damper"),
    ("moment", "torque"),
    ("ramp", "constant-rate"),
    ("linear", "constant-rate"),
    ("sine", "harmonic"),
    ("sin", "harmonic"),
    ("cosine", "harmonic"),
    ("spline", "table"),
    ("rotation", "angle"),
    ("toe", "angle"),
    ("camber", "inclination"),
    ("position", "displacement"),
    ("link", "body"),
    ("part", "body"),
    ("constraint", "joint"),
    ("site", "marker"),
    ("frame", "marker"),
    ("sensor", "measure"),
    ("request", "measure"),
    ("motor", "drive"),
    ("actuator", "drive"),
    ("load", "force"),
    ("run", "simulate"),
    ("simulation", "simulate"),
    ("solver", "simulate"),
    ("variables", "parameters"),
    ("dt", "output_step"),
    ("step", "output_step"),
    ("duration", "t_end"),
    ("end_time", "t_end"),
    ("stop_time", "t_end"),
    ("tend", "t_end"),
    ("axes", "axis"),
    ("3d", "spatial"),
    ("space", "spatial"),
    ("2d", "plane"),
    ("integrator", "method"),
    ("solver", "method"),
    ("abstol", "atol"),
    ("reltol", "rtol"),
    ("theta", "angle"),
    ("orientation", "angle"),
    ("omega", "angular_velocity"),
    ("com", "centre"),
    ("cog", "centre"),
    ("center", "centre"),
    ("center_of_mass", "centre"),
    ("centre_of_mass", "centre"),
    ("enabled", "active"),
    ("suppressed", "active"),
    ("location", "at"),
    ("rest_length", "free_length"),
    ("preload", "free_length"),
    ("k", "stiffness"),
    ("c", "damping"),
    ("g", "gravity"),
    ("-o", "--out"),
    ("--dt", "--max-step"),
];

/// Returns the candidate that is most similar to `name`, if a candidate is similar enough. A
/// candidate is similar if other programs use `name` for it, or if the candidate is the plural or
/// the singular of `name`. A candidate is also similar if at most a third of its letters (but not
/// all) differ.
///
/// ```
/// assert_eq!(pfaff_scene::nearest("hinge", ["fixed", "revolute"]), Some("revolute"));
/// assert_eq!(pfaff_scene::nearest("dor", ["cart", "door"]), Some("door"));
/// assert_eq!(pfaff_scene::nearest("bolt", ["cart", "door"]), None);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let singular = name.strip_suffix("ies").map(|stem| format!("{stem}y"));
    let name = singular.as_deref().unwrap_or(name);
    let letters = name.chars().count();
    let mut rows = Rows::default();
    let (mut wanted, mut other) = (Vec::new(), Vec::new());
    lower(name, &mut wanted);
    let one = name.strip_suffix('s').unwrap_or(name);
    let is_said = |said: &str| {
        [name, one]
            .iter()
            .any(|name| name.eq_ignore_ascii_case(said))
    };
    let known = ELSEWHERE.iter().filter(|(said, _)| is_said(said));
    let meant: Vec<&str> = known.map(|(_, meant)| *meant).collect();
    let mut best: Option<(usize, &'a str)> = None;
    for candidate in candidates {
        if meant.contains(&candidate) {
            return Some(candidate);
        }
        if letters.max(candidate.len()) > LONGEST {
            continue;
        }
        let longer = letters.max(candidate.chars().count());
        let allowed = longer.div_ceil(3).min(longer.saturating_sub(1));
        let limit = match best {
            Some((0, _)) => break,
            Some((distance, _)) => allowed.min(distance - 1),
            None => allowed,
        };
        lower(candidate, &mut other);
        if let Some(distance) = rows.distance(&wanted, &other, limit) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Returns the name used here for a name in other programs and books, if the two names differ.
pub(crate) fn meant(name: &str) -> Option<&'static str> {
    let mut known = ELSEWHERE.iter();
    known.find_map(|(said, here)| name.eq_ignore_ascii_case(said).then_some(*here))
}

/// The advice `did you mean …?`, if a candidate is similar enough.
pub(crate) fn did_you_mean<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    nearest(name, candidates).map(|candidate| format!("did you mean `{candidate}`?"))
}

/// Largest number of names that a piece of advice lists.
const LISTED: usize = 10;

/// The advice `the … are …`, if there are few names.
pub(crate) fn all<'a>(what: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let names: Vec<_> = names.into_iter().take(LISTED + 1).collect();
    let few = (1..=LISTED).contains(&names.len());
    few.then(|| format!("the {what} are {}", list(names)))
}

/// Names for a list in a message: `a`, `b`, `c`.
pub(crate) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<_> = names.into_iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// Writes the lower-case characters of a text to `out`, so that comparisons ignore upper and lower
/// case.
fn lower(text: &str, out: &mut Vec<char>) {
    out.clear();
    if text.is_ascii() {
        out.extend(text.bytes().map(|b| char::from(b.to_ascii_lowercase())));
    } else {
        out.extend(text.chars().flat_map(char::to_lowercase));
    }
}

/// Three rows of the table of edit distances between initial parts of two texts.
#[derive(Default)]
struct Rows {
    before: Vec<usize>,
    last: Vec<usize>,
    row: Vec<usize>,
}

impl Rows {
    /// Returns the number of insertions, deletions, replacements and exchanges of neighbouring
    /// letters between two texts (optimal string alignment). Returns `None` if the number is above
    /// `limit`.
    fn distance(&mut self, a: &[char], b: &[char], limit: usize) -> Option<usize> {
        if a.len().abs_diff(b.len()) > limit {
            return None;
        }
        for row in [&mut self.before, &mut self.last, &mut self.row] {
            row.clear();
            row.resize(b.len() + 1, 0);
        }
        for (j, x) in self.last.iter_mut().enumerate() {
            *x = j;
        }
        // An exchange of neighbours uses the last row but one. Therefore no later distance is below
        // the smaller of the minima of the last two rows.
        let mut least_before = 0;
        for i in 1..=a.len() {
            let Self { before, last, row } = self;
            row[0] = i;
            let mut least = i;
            for j in 1..=b.len() {
                let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
                row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
                if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                    row[j] = row[j].min(before[j - 2] + 1);
                }
                least = least.min(row[j]);
            }
            if least.min(least_before) > limit {
                return None;
            }
            least_before = least;
            std::mem::swap(before, last);
            std::mem::swap(last, row);
        }
        Some(self.last[b.len()]).filter(|distance| *distance <= limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_counted() {
        for (a, b, expected) in [
            ("chasis", "chassis", 1),
            ("axsi", "axis", 1),
            ("At", "at", 0),
            ("", "abc", 3),
            ("kitten", "sitting", 3),
        ] {
            let (mut x, mut y) = (Vec::new(), Vec::new());
            lower(a, &mut x);
            lower(b, &mut y);
            for (x, y) in [(&x, &y), (&y, &x)] {
                for limit in 0..6 {
                    let found = Rows::default().distance(x, y, limit);
                    let within = (expected <= limit).then_some(expected);
                    assert_eq!(found, within, "{a} {b}, at most {limit}");
                }
            }
        }
    }

    #[test]
    fn words_of_other_programs_are_known_where_they_can_be_meant() {
        let types = ["distance", "fixed", "revolute", "translational"];
        assert_eq!(nearest("Hinge", types), Some("revolute"));
        assert_eq!(nearest("prismatic", types), Some("translational"));
        assert_eq!(nearest("link", types), Some("distance"));
        assert_eq!(nearest("links", ["body", "joint"]), Some("body"));
        assert_eq!(nearest("dt", ["rtol", "output_step"]), Some("output_step"));
        assert_eq!(nearest("motor", ["rotor", "joint"]), Some("rotor"));
        for (k, pair) in ELSEWHERE.iter().enumerate() {
            assert!(!ELSEWHERE[..k].contains(pair), "{pair:?}");
        }
    }

    #[test]
    fn far_names_are_not_suggested() {
        assert_eq!(nearest("revolut", ["fixed", "revolute"]), Some("revolute"));
        assert_eq!(nearest("bolt", ["fixed", "revolute"]), None);
        assert_eq!(nearest("D", ["A", "B"]), None);
        assert_eq!(nearest("a", ["B", "A"]), Some("A"));
        assert_eq!(nearest("bodies", ["joint", "body"]), Some("body"));
        // If several candidates are equally similar, the first one is used.
        let near = nearest("crank-10", ["crank-1", "crank-20", "Crank-10", "crank-10"]);
        assert_eq!(near, Some("Crank-10"));
    }
}
