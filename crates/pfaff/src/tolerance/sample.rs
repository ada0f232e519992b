//! One sample: the mechanism with displaced data, which is assembled again, and its reactions.
//!
//! The numbers of a sample are analysed in two ways. *On the independent rows* of the described
//! mechanism, the sample has the redundancy of the described mechanism. The redundant rows have
//! small violations, which are possible because of clearance or elasticity. Reactions that are
//! unique in the described mechanism have values in the sample. *With exact numbers*, all rows
//! count at this configuration, as for rigid bodies without clearance. If redundant rows are now
//! independent, the mechanism has fewer free motions, and the data alone determine the numbers that
//! were not unique.
//!
//! Assembly is not damped, because nearly dependent rows are important here. The rank of all rows
//! is decided at the assembled pose with exact numbers, as for a plain matrix.

use linalg::kernels::max_abs;
use linalg::{KeptRowSaddle, Matrix};
use model::start::requirement;
use model::words::{rough, short};
use model::{ConstraintId, Level, Mechanism, Scratch, System};
use rank::{RankDecision, RankStatus};
use solvability::{CarriedContacts, Configuration, Elasticity, Equations, RowTerms, opened};

use crate::elasticity::centres;
use scene::Scene;

use super::draw::Stream;
use super::failed::SampleFailure;
use super::limits::SHARED;
use super::nominal::{Base, DisplacedDatum, Nominal, SampleBounds, SampleContacts};
use super::quantity::Quantity;
use super::vary::VariedText;

/// Largest distance between the configuration of a sample and the described configuration: a
/// fraction of the size of the mechanism, or an angle (rad). At a larger distance, the
/// configuration counts as another assembly of the same parts.
pub(super) const FAR: f64 = 0.3;

/// Largest number of iterations towards a configuration. Within a tolerance, a few iterations are
/// sufficient. More iterations are needed if the rows are nearly dependent.
const ITERATIONS: usize = 40;

/// A configuration satisfies its rows if the residuals are below this multiple of the rounding
/// errors of the terms. If the iteration no longer improves, the next constant is the limit.
const ROUNDINGS: f64 = 10.0;
const STILL: f64 = 1e3;

/// The reason for samples whose rows contradict each other or nearly contradict each other.
const NO_POSE: &str = "no pose near the described one satisfies the rows";

fn unassembled(e: linalg::SaddleError) -> SampleFailure {
    SampleFailure::new(NO_POSE, e)
}

/// Velocities satisfy the other rows to this fraction of the largest velocity.
const SATISFIED: f64 = 1e-9;

/// The result of a sample.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Number of the sample, counted from 1.
    pub number: u64,
    /// The results, or the reason why the sample could not be assembled.
    pub outcome: Result<AssembledSample, SampleFailure>,
    /// Positions of varied numbers in their intervals, from −1 to 1.
    pub varied: Vec<f64>,
}

/// A sample that was assembled.
#[derive(Clone, Debug)]
pub struct AssembledSample {
    /// Rank of all rows with exact numbers. `None` if the rank is undecided.
    pub rank: Option<usize>,
    /// The verdict on each joint and drive with exact numbers.
    pub verdicts: Vec<&'static str>,
    /// The verdict on each number of a reaction with the described redundancy. A number is not
    /// unique if it depends, even weakly, on the distribution of the loads over the redundant rows.
    pub of_kept: Vec<&'static str>,
    /// The values of reactions on the independent rows. A value is NaN if it is not unique.
    pub kept: Vec<f64>,
    /// Bounds of the values that are not unique on the independent rows. Values without bounds have
    /// NaN. The list is empty if no bounds were requested.
    pub bounds: Vec<[f64; 2]>,
    /// The values with exact numbers. A value is NaN if it is not unique or unknown.
    pub exact: Vec<f64>,
    /// Violation of each redundant holonomic row (m or rad).
    pub misfits: Vec<f64>,
    /// Displacement (m) and rotation (rad) of the frame of each body.
    pub moved: Vec<[f64; 2]>,
    /// Positions of markers (m).
    pub markers: Vec<[f64; 3]>,
    /// Values of joint coordinates (measures).
    pub measures: Vec<f64>,
    /// The one-sided joints that open with the described redundancy. The list is empty if all
    /// one-sided joints can stay closed.
    pub opened: Vec<ConstraintId>,
    /// Ranges of the values over the loads that one-sided joints permit, with the described
    /// redundancy: infinite without a limit, NaN if the joints open or if the range is not clear;
    /// empty if no joint is one-sided, or if no row is redundant.
    pub permitted: Vec<[f64; 2]>,
}

impl Nominal {
    /// Computes a sample. The result depends only on the seed and the number of the sample.
    pub(super) fn sample(&self, vary: Option<&VariedText<'_>>, seed: u64, number: u64) -> Sample {
        let shares = vary
            .map(|vary| vary.shares(seed, number))
            .unwrap_or_default();
        let outcome = match vary {
            None => {
                let numbers = displaced_numbers(&self.mechanism, &self.data, seed, number);
                self.assembled(&self.mechanism.with_numbers(&numbers), &self.base)
            }
            Some(vary) => vary
                .described(self, &shares)
                .and_then(|(mechanism, base, data)| {
                    let numbers = displaced_numbers(&mechanism, &data, seed, number);
                    self.assembled(&mechanism.with_numbers(&numbers), &base)
                }),
        };
        Sample {
            number,
            outcome,
            varied: shares,
        }
    }

    /// Analyses a mechanism with these data.
    pub(super) fn assembled(
        &self,
        mechanism: &Mechanism,
        base: &Base,
    ) -> Result<AssembledSample, SampleFailure> {
        let q = self.pose_of(mechanism, base)?;
        let mut s = mechanism.scratch();
        mechanism.pose(self.t, &q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        mechanism.b(&mut s);
        let Instant { v, lambda } = self.instant(mechanism, base, &mut s)?;
        let misfits = self.missing.iter().map(|row| s.phi[*row]).collect();
        // Violations of redundant rows are not errors of C. Here C is accurate to rounding.
        s.phi.fill(0.0);
        let decision = solvability::decide(mechanism, &s, &q)
            .map_err(|e| SampleFailure::new("the rank cannot be decided", e))?;
        let (verdicts, exact) =
            self.with_exact_numbers(mechanism, (&s, &q, &v), &decision, &lambda);
        let of_kept = self.on_kept_rows(mechanism, &s, &q);
        let bounds = self.bounds_of((mechanism, &q), of_kept.as_ref(), &lambda);
        let (opened, permitted) = self.carried((mechanism, &s, &q, &v), &lambda);
        let of_kept = self.verdicts_of(mechanism, of_kept.as_ref());
        let numbers = self.numbers_of(mechanism, &s, &lambda).into_iter();
        let kept = numbers.zip(&of_kept).map(|(x, verdict)| match *verdict {
            "unique" => x,
            _ => f64::NAN,
        });
        let kept = kept.collect();
        let frames = mechanism.frames();
        let observed = frames.observed();
        Ok(AssembledSample {
            rank: (decision.status == RankStatus::Decided).then_some(decision.rank),
            verdicts,
            of_kept,
            kept,
            bounds,
            exact,
            misfits,
            moved: self.moved(mechanism, &q),
            markers: (0..observed.markers.len())
                .map(|k| frames.marker(k, &q, &v).place)
                .collect(),
            measures: (0..observed.measures.len())
                .map(|k| frames.measure(k, &q, &v))
                .collect(),
            opened,
            permitted,
        })
    }

    /// Returns the configuration that satisfies the independent rows and is nearest to the
    /// described configuration.
    fn pose_of(&self, mechanism: &Mechanism, base: &Base) -> Result<Vec<f64>, SampleFailure> {
        let q = self.closest(mechanism, &base.q)?;
        requirement(mechanism, &q)
            .map_err(|e| SampleFailure::new("a requirement of a joint is not satisfied", e))?;
        let space = mechanism.space();
        let moved = mechanism.difference_of(&q, &self.base.q);
        let share = |j: usize| moved[j].abs() / space.unit(j, self.size);
        let farthest = (0..moved.len()).fold(0, |a, j| if share(j) > share(a) { j } else { a });
        if moved.is_empty() || share(farthest) <= FAR {
            return Ok(q);
        }
        let (body, coordinate) = mechanism.coordinate(farthest);
        Err(SampleFailure::new(
            "the nearest pose is far from the described one",
            format!(
                "{coordinate} of `{body}` differs by {}",
                short(moved[farthest])
            ),
        ))
    }

    /// Returns the configuration that satisfies the independent position constraints and is closest
    /// to the configuration given in the scene. Distances are lengths; angles are multiplied by the
    /// size of the mechanism. Each iteration computes `q = q₀ + argmin ‖δ‖` under the constraints
    /// linearised at q. Coordinates that are fixed at the start do not change.
    fn closest(&self, mechanism: &Mechanism, base: &[f64]) -> Result<Vec<f64>, SampleFailure> {
        let (space, rows) = (mechanism.space(), &self.position_kept);
        let n = mechanism.layout().n_v;
        let square = self.size * self.size;
        let weight = |j| if space.is_rotation(j) { square } else { 1.0 };
        let weights: Vec<f64> = (0..n).map(weight).collect();
        let mut saddle = KeptRowSaddle::new(n, rows.len()).map_err(unassembled)?;
        let mut s = mechanism.scratch();
        let mut q = base.to_vec();
        let (mut step, mut of_rows) = (vec![0.0; n], vec![0.0; rows.len()]);
        let mut best = f64::INFINITY;
        for _ in 0..ITERATIONS {
            mechanism.pose(self.t, &q, &mut s);
            mechanism.phi(&mut s);
            mechanism.c(&mut s);
            let misses = |&i: &usize| match s.phi[i] {
                0.0 => 0.0,
                phi => phi.abs() / mechanism.scales(&s).position(i),
            };
            let residual = rows.iter().map(misses).fold(0.0, f64::max);
            // Because of rounding errors, the residual may stay slightly above the first bound.
            // Then the iteration no longer improves.
            let is_still = residual >= best && residual <= STILL * f64::EPSILON;
            if residual <= ROUNDINGS * f64::EPSILON || is_still {
                return Ok(q);
            }
            best = best.min(residual);
            let mut c = mechanism.layout().dense(&s);
            let back = mechanism.difference_of(base, &q);
            let held: Vec<f64> = rows
                .iter()
                .map(|&i| {
                    let moved = c.row(i).iter().zip(&back).map(|(c, d)| c * d).sum::<f64>();
                    -s.phi[i] - moved
                })
                .collect();
            for &j in &self.kept_columns {
                for &i in rows {
                    c[(i, j)] = 0.0;
                }
            }
            saddle
                .factor(|k| c.row(rows[k]), &weights)
                .map_err(unassembled)?;
            saddle
                .solve(&vec![0.0; n], &held, &mut step, &mut of_rows)
                .map_err(unassembled)?;
            q = space.displaced(base, 1.0, &step);
        }
        let worst = rows
            .iter()
            .copied()
            .max_by(|a, b| s.phi[*a].abs().total_cmp(&s.phi[*b].abs()));
        let detail = worst.map_or(String::new(), |i| {
            format!(
                "row {} is still violated by {}",
                mechanism.layout().labels[i],
                rough(s.phi[i].abs())
            )
        });
        Err(SampleFailure::new(NO_POSE, detail))
    }

    /// Computes the velocities that satisfy the independent rows and are nearest to the described
    /// velocities in the mass metric. Also computes the multipliers at these velocities.
    fn instant(
        &self,
        mechanism: &Mechanism,
        base: &Base,
        s: &mut Scratch,
    ) -> Result<Instant, SampleFailure> {
        let c = mechanism.layout().dense(s);
        let kept = &self.kept;
        let failed = |e: linalg::SaddleError| {
            SampleFailure::new("masses and rows do not determine the accelerations", e)
        };
        let (n, r) = (c.ncols(), kept.len());
        let mut saddle = KeptRowSaddle::new(n, r).map_err(failed)?;
        saddle
            .factor(|k| c.row(kept[k]), mechanism.inertia(s))
            .map_err(failed)?;
        let of_kept = |all: &[f64]| -> Vec<f64> { kept.iter().map(|&i| all[i]).collect() };
        let momentum = mechanism.inertia(s).product(&base.v);
        let (mut v, mut impulses) = (vec![0.0; n], vec![0.0; r]);
        let is_still = base.v.iter().all(|v| *v == 0.0) && s.b.iter().all(|b| *b == 0.0);
        if !is_still {
            saddle
                .solve(&momentum, &of_kept(&s.b), &mut v, &mut impulses)
                .map_err(failed)?;
        }
        mechanism.twist(&v, s);
        mechanism.gamma(s);
        mechanism.force(s);
        let (mut a, mut of_rows) = (vec![0.0; n], vec![0.0; r]);
        saddle
            .solve(&s.force, &of_kept(&s.gamma), &mut a, &mut of_rows)
            .map_err(failed)?;
        let mut lambda = vec![0.0; c.nrows()];
        for (&row, value) in kept.iter().zip(of_rows) {
            lambda[row] = value;
        }
        if lambda.iter().chain(&a).any(|x| !x.is_finite()) {
            return Err(SampleFailure::new(
                "forces are not finite",
                "their sizes overflow",
            ));
        }
        Ok(Instant { v, lambda })
    }

    /// Analyses the configuration with the described redundancy. Returns `None` if it cannot be
    /// analysed. Redundant rows count as redundant although they have violations, and the loads
    /// that they share are not determined.
    fn on_kept_rows<'m>(
        &self,
        mechanism: &'m Mechanism,
        s: &Scratch,
        q: &[f64],
    ) -> Option<Configuration<'m>> {
        let decision = self.described_decision(mechanism, s, q)?;
        Configuration::new(mechanism, self.t, q, &decision).ok()
    }

    /// Returns the decision with the described redundancy. Returns `None` if there are no redundant
    /// rows.
    fn described_decision(
        &self,
        mechanism: &Mechanism,
        s: &Scratch,
        q: &[f64],
    ) -> Option<RankDecision> {
        let rows = mechanism.layout().rows();
        if self.kept.len() == rows {
            return None;
        }
        let dropped: Vec<usize> = (0..rows)
            .filter(|i| self.kept.binary_search(i).is_err())
            .collect();
        let of_rank = (rows, self.kept.len());
        solvability::decide_of_rank(mechanism, s, q, of_rank, Some(&dropped)).ok()
    }

    /// Returns the verdicts on the numbers with the described redundancy. In a misaligned
    /// mechanism, each component is analysed separately, even if the component is zero in the
    /// described mechanism.
    fn verdicts_of(
        &self,
        mechanism: &Mechanism,
        at: Option<&Configuration<'_>>,
    ) -> Vec<&'static str> {
        let is_whole = self.kept.len() == mechanism.layout().rows();
        let verdict = |quantity: &Quantity| match at {
            Some(at) => quantity.verdict(mechanism, at, SHARED),
            None if is_whole => "unique",
            None => "undecided",
        };
        self.quantities.iter().map(verdict).collect()
    }

    /// Returns the described configuration, if it has redundant rows and can be analysed.
    fn described_configuration(&self) -> Option<Configuration<'static>> {
        let (mechanism, q) = (&self.mechanism, &self.base.q);
        let mut s = mechanism.scratch();
        mechanism.pose(self.t, q, &mut s);
        mechanism.c(&mut s);
        let decision = self.described_decision(mechanism, &s, q)?;
        Configuration::owned(mechanism, self.t, q, &decision).ok()
    }

    /// Prepares bounds for elastic joints. The self-stresses are those of the described
    /// configuration.
    pub(super) fn sample_bounds(&self, scene: Scene, elasticity: Elasticity) -> SampleBounds {
        SampleBounds {
            configuration: self.described_configuration(),
            elasticity: Elasticity {
                centres: centres(&scene, &self.mechanism, &self.base.q),
                ..elasticity
            },
            scene,
        }
    }

    /// Prepares the one-sided joints, unless there are none or the described configuration cannot
    /// be analysed.
    pub(super) fn sample_contacts(&self) -> Option<SampleContacts> {
        let joints = CarriedContacts::of(&self.mechanism)?;
        let is_whole = self.kept.len() == self.mechanism.layout().rows();
        let described = self.described_configuration();
        if !is_whole && described.is_none() {
            return None;
        }
        let form = |at: &Configuration<'_>, quantity: &Quantity| {
            let form = quantity.form(at);
            form.map_or_else(Vec::new, |form| form.coefficients().to_vec())
        };
        let (dependencies, forms) = match &described {
            None => (Vec::new(), Vec::new()),
            Some(at) => (
                at.solvability().dependencies(),
                self.quantities.iter().map(|q| form(at, q)).collect(),
            ),
        };
        Some(SampleContacts {
            joints,
            dependencies,
            forms,
        })
    }

    /// Returns bounds of the numbers with the described redundancy, if they are requested.
    fn bounds_of(
        &self,
        (mechanism, q): (&Mechanism, &[f64]),
        at: Option<&Configuration<'_>>,
        lambda: &[f64],
    ) -> Vec<[f64; 2]> {
        let Some(asked) = &self.bounds else {
            return Vec::new();
        };
        let centres = centres(&asked.scene, mechanism, q);
        let found = asked.configuration.as_ref().zip(at).map(|(described, at)| {
            described.elastic_solutions_displaced((at, &centres), lambda, &asked.elasticity)
        });
        let of = |quantity: &Quantity| match (&found, at) {
            (Some(Ok(found)), Some(at)) => quantity.bounds(at, found),
            _ => [f64::NAN; 2],
        };
        self.quantities.iter().map(of).collect()
    }

    /// Returns the one-sided joints that open with the described redundancy, and the ranges of all
    /// numbers over the loads that these joints permit.
    fn carried(
        &self,
        (mechanism, s, q, v): (&Mechanism, &Scratch, &[f64], &[f64]),
        lambda: &[f64],
    ) -> (Vec<ConstraintId>, Vec<[f64; 2]>) {
        let Some(contacts) = &self.contacts else {
            return (Vec::new(), Vec::new());
        };
        let solution = (lambda, max_abs(&s.force));
        let carried = (contacts.joints).permitted((mechanism, s), solution, &contacts.dependencies);
        let opening = match carried.opening().opening.as_slice() {
            [] => Vec::new(),
            opening => opened(mechanism, (self.t, q, v), opening),
        };
        let range = |form: &Vec<f64>| match form.as_slice() {
            [] => [f64::NAN; 2],
            form => carried.range(form).unwrap_or([f64::NAN; 2]),
        };
        let ranges = contacts.forms.iter().map(range).collect();
        (opening, ranges)
    }

    /// Returns the verdicts with exact numbers at this configuration, and the values that are
    /// unique according to these verdicts.
    fn with_exact_numbers(
        &self,
        mechanism: &Mechanism,
        (s, q, v): (&Scratch, &[f64], &[f64]),
        decision: &RankDecision,
        lambda: &[f64],
    ) -> (Vec<&'static str>, Vec<f64>) {
        let groups = mechanism.layout().groups.len();
        let nothing = vec![f64::NAN; self.quantities.len()];
        if decision.status != RankStatus::Decided {
            return (vec!["undecided"; groups], nothing);
        }
        let multipliers = self.exact_multipliers(mechanism, (s, v), decision, lambda);
        let values = match &multipliers {
            Some(lambda) => self.numbers_of(mechanism, s, lambda),
            None => nothing,
        };
        if decision.redundancy == 0 {
            return (vec!["unique"; groups], values);
        }
        let Ok(configuration) = Configuration::new(mechanism, self.t, q, decision) else {
            return (vec!["undecided"; groups], vec![f64::NAN; values.len()]);
        };
        let is_unique =
            |quantity: &Quantity| quantity.verdict(mechanism, &configuration, 0.0) == "unique";
        let values = (self.quantities.iter().zip(values))
            .map(|(quantity, value)| if is_unique(quantity) { value } else { f64::NAN });
        let values = values.collect();
        let verdict = |group: &model::reaction::ConstraintGroup| {
            let judged = configuration.solvability().group(group.rows.clone());
            judged.map_or("undecided", |judged| judged.verdict.word())
        };
        let verdicts = mechanism.layout().groups.iter().map(verdict).collect();
        (verdicts, values)
    }

    /// Returns the multipliers of all rows with exact numbers. The multipliers of redundant rows
    /// are zero. Returns `None` if the velocities violate a row that is now independent, or if
    /// redundant rows contradict each other. In these cases, the mechanism cannot perform this
    /// motion without clearance.
    fn exact_multipliers(
        &self,
        mechanism: &Mechanism,
        (s, v): (&Scratch, &[f64]),
        decision: &RankDecision,
        lambda: &[f64],
    ) -> Option<Vec<f64>> {
        if decision.kept == self.kept {
            return Some(lambda.to_vec());
        }
        let layout = mechanism.layout();
        let size = self.size;
        let level = Level::velocities(mechanism, size, v);
        let terms = |i: usize| mechanism.scales(s).terms(i, &level);
        let holds = |i: usize| layout.velocity_residual(s, i, v).abs() <= SATISFIED * terms(i);
        if !(0..layout.rows()).all(holds) {
            return None;
        }
        let c: Matrix = layout.dense(s);
        let equations = Equations {
            mass: mechanism.mass().to_vec(),
            added: mechanism.inertia(s).added().clone(),
            force: s.force.clone(),
            gamma: s.gamma.clone(),
            terms: RowTerms::of(mechanism, s, v, size),
            c,
        };
        let found = equations.multipliers(decision).ok()?;
        Some(found.as_chosen().to_vec())
    }

    /// Returns the values of all reactions for these multipliers.
    fn numbers_of(&self, mechanism: &Mechanism, s: &Scratch, lambda: &[f64]) -> Vec<f64> {
        let (reactions, space) = (mechanism.reactions(s), mechanism.space());
        let mut block = Vec::new();
        let ids = mechanism.layout().constraint_ids();
        let all: Vec<_> = ids
            .map(|id| reactions.reaction_in(&mut block, id, lambda))
            .collect();
        let value = |quantity: &Quantity| quantity.of_reaction(space, &all[quantity.id.0]);
        self.quantities.iter().map(value).collect()
    }

    /// Returns the distance of the frame of each body from the described configuration.
    fn moved(&self, mechanism: &Mechanism, q: &[f64]) -> Vec<[f64; 2]> {
        let still = vec![0.0; mechanism.layout().n_v];
        let (frames, space) = (mechanism.frames(), mechanism.space());
        let turned = mechanism.difference_of(q, &self.base.q);
        (0..mechanism.bodies().len())
            .map(|body| {
                let [now, then] = [q, &self.base.q].map(|q| frames.body(body, q, &still).place);
                let apart: Vec<f64> = now.iter().zip(then).map(|(a, b)| a - b).collect();
                let angle = &turned[space.rotations_of(body)];
                [&apart[..], angle].map(linalg::kernels::norm)
            })
            .collect()
    }
}

/// Returns the numbers of the constraints of a sample.
fn displaced_numbers(
    mechanism: &Mechanism,
    data: &[DisplacedDatum],
    seed: u64,
    number: u64,
) -> Vec<f64> {
    let mut numbers = mechanism.data().numbers();
    for displaced in data {
        let block = &displaced.block;
        let mut stream = Stream::new(seed, number, displaced.stream);
        let by = stream.ball(block.directions());
        let by = by.map(|x| x * displaced.tolerance);
        let own = &mut numbers[block.numbers.clone()];
        let moved = block.displaced(own, by);
        own.copy_from_slice(&moved);
    }
    numbers
}

/// Velocities, and the multipliers of the independent rows.
struct Instant {
    v: Vec<f64>,
    lambda: Vec<f64>,
}
