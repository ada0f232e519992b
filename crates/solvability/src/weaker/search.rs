//! The cheapest replacements of coupled joints.

use super::extend;
use crate::limits::{CLEARLY_RELEASED, REPLACEMENT_STEPS, REPLACEMENT_WAYS, TIED_CLEARNESS};

/// A weaker joint that replaces a joint.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    /// Index in the list of the caller.
    pub(super) index: usize,
    /// The released load components as functions of the free multipliers.
    pub(super) forms: Vec<Vec<f64>>,
    /// Cost of the replacement.
    pub(super) cost: usize,
}

/// A set of replacements.
struct Way {
    cost: usize,
    /// Logarithm of the product of the remainders. A larger value means a better determined set.
    clearness: f64,
    chosen: Vec<usize>,
}

/// Depth-first search over the joints.
struct Search {
    /// The candidates of each joint. The candidates with the smallest cost for each component come
    /// first.
    joints: Vec<Vec<Candidate>>,
    /// For each joint: the number of components that this joint and the later joints can release,
    /// and their smallest cost for one component.
    later: Vec<(usize, f64)>,
    /// Number of components that have to be released.
    free: usize,
    /// Sets with at least this cost are left out, if there is such a limit.
    below: Option<usize>,
    ways: Vec<Way>,
    steps: usize,
}

/// Returns the cheapest sets of candidates, with at most one candidate for each joint. The
/// candidates of a set together release `free` independent components and cost less than `below`.
/// Among sets with the same cost, the set whose components are farthest from being dependent comes
/// first.
pub(super) fn cheapest(
    mut joints: Vec<Vec<Candidate>>,
    free: usize,
    below: Option<usize>,
) -> Vec<Vec<usize>> {
    for candidates in &mut joints {
        candidates.retain(|candidate| {
            let released = extend(&mut Vec::new(), &candidate.forms, CLEARLY_RELEASED);
            !released.is_empty() && released.len() == candidate.forms.len()
        });
        candidates.sort_by(|a, b| each(a).total_cmp(&each(b)));
    }
    // Joints that can release the most components come first, because they leave the fewest
    // possibilities.
    joints.sort_by_key(|candidates| std::cmp::Reverse(most(candidates)));
    let mut later = vec![(0, f64::INFINITY); joints.len() + 1];
    for (k, candidates) in joints.iter().enumerate().rev() {
        let (released, least) = later[k + 1];
        let own = candidates.first().map_or(f64::INFINITY, each);
        later[k] = (released + most(candidates), least.min(own));
    }
    let mut search = Search {
        joints,
        later,
        free,
        below,
        ways: Vec::new(),
        steps: 0,
    };
    search.decide(0, &[], (0, 0.0), &mut Vec::new());
    search.ways.into_iter().map(|way| way.chosen).collect()
}

/// Returns the cost of a candidate for each released component.
fn each(candidate: &Candidate) -> f64 {
    candidate.cost as f64 / candidate.forms.len() as f64
}

/// Returns the largest number of components that a single candidate releases.
fn most(candidates: &[Candidate]) -> usize {
    let released = candidates.iter().map(|candidate| candidate.forms.len());
    released.max().unwrap_or(0)
}

impl Search {
    /// Decides on the joint `at` and on all later joints. `released` is an orthonormal basis of the
    /// components that the earlier joints release.
    fn decide(
        &mut self,
        at: usize,
        released: &[Vec<f64>],
        (cost, clearness): (usize, f64),
        chosen: &mut Vec<usize>,
    ) {
        let missing = self.free - released.len();
        let (possible, least) = self.later[at];
        let at_least = match missing {
            0 => cost as f64,
            missing => cost as f64 + least * missing as f64,
        };
        // Costs are whole numbers.
        let is_worse = |most: usize| at_least > most as f64 - 0.5;
        if self.below.is_some_and(is_worse) {
            return;
        }
        if missing == 0 {
            self.add(Way {
                cost,
                clearness,
                chosen: chosen.clone(),
            });
            return;
        }
        self.steps += 1;
        let is_known = self.ways.len() == REPLACEMENT_WAYS;
        if missing > possible
            || self.steps > REPLACEMENT_STEPS
            || is_known && self.ways.last().is_some_and(|way| is_worse(way.cost + 1))
        {
            return;
        }
        for k in 0..self.joints[at].len() {
            let candidate = &self.joints[at][k];
            if candidate.forms.len() > missing {
                continue;
            }
            let mut basis = released.to_vec();
            let added = extend(&mut basis, &candidate.forms, CLEARLY_RELEASED);
            if added.len() == candidate.forms.len() {
                let clearness = clearness + added.iter().map(|x| x.ln()).sum::<f64>();
                let cost = cost + candidate.cost;
                chosen.push(candidate.index);
                self.decide(at + 1, &basis, (cost, clearness), chosen);
                chosen.pop();
            }
        }
        self.decide(at + 1, released, (cost, clearness), chosen);
    }

    /// Adds a set to the cheapest sets.
    fn add(&mut self, way: Way) {
        let is_better = |known: &Way| {
            known.cost < way.cost
                || known.cost == way.cost && way.clearness - known.clearness < TIED_CLEARNESS
        };
        let at = self.ways.partition_point(is_better);
        self.ways.insert(at, way);
        self.ways.truncate(REPLACEMENT_WAYS);
    }
}
