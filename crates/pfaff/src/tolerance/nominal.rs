//! The described mechanism: its configuration, the independent rows, the displaced data, and the
//! verdicts on its reactions.

use model::start::KeepLevel;
use model::{ConstraintId, DataBlock, DataUnit, Mechanism, System};
use rank::Doubt;
use scene::Scene;
use solvability::{CarriedContacts, Configuration, Elasticity, RowDecision, rows_of_rank};

use super::error::ToleranceError;
use super::quantity::Quantity;
use crate::assembled::AssembledScene;
use crate::error::StudyError;
use crate::run_options::RunOptions;
use crate::study::Study;

/// A datum that is displaced in the samples.
#[derive(Clone, Debug)]
pub(super) struct DisplacedDatum {
    pub(super) block: DataBlock,
    /// Largest displacement of the datum (in its unit).
    pub(super) tolerance: f64,
    /// The stream of the random numbers of the datum. A drive uses the streams of its joint,
    /// because both have the same points.
    pub(super) stream: u64,
}

/// The rank with which the described mechanism is analysed within its tolerances.
#[derive(Clone, Debug)]
pub(super) enum Reading {
    Decided,
    /// The rank is between two values. The lower value is used, and no reaction counts as unique.
    Undecided(String),
}

/// Verdict on a joint or drive of the described mechanism.
#[derive(Clone, Debug)]
pub(super) struct NominalReaction {
    pub(super) name: String,
    pub(super) kind: &'static str,
    pub(super) verdict: &'static str,
    pub(super) fragile: bool,
}

/// A state from which samples are assembled.
#[derive(Clone, Debug)]
pub(super) struct Base {
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
}

/// The described mechanism at one time.
pub(super) struct Nominal {
    pub(super) scene: String,
    pub(super) mechanism: Mechanism,
    pub(super) t: f64,
    pub(super) base: Base,
    /// Columns of C whose coordinates are fixed at the start.
    pub(super) kept_columns: Vec<usize>,
    pub(super) size: f64,
    pub(super) data: Vec<DisplacedDatum>,
    pub(super) reading: Reading,
    pub(super) rank: usize,
    /// Independent rows of C.
    pub(super) kept: Vec<usize>,
    /// Independent rows of Φq.
    pub(super) position_kept: Vec<usize>,
    /// The redundant rows of Φq.
    pub(super) missing: Vec<usize>,
    pub(super) reactions: Vec<NominalReaction>,
    pub(super) quantities: Vec<Quantity>,
    /// The verdict on each quantity for the rank of the described mechanism.
    pub(super) verdicts: Vec<&'static str>,
    /// The request for bounds, if there is one.
    pub(super) bounds: Option<SampleBounds>,
    /// The one-sided joints, if there are any.
    pub(super) contacts: Option<SampleContacts>,
}

/// The one-sided joints of all samples.
pub(super) struct SampleContacts {
    pub(super) joints: CarriedContacts,
    /// One dependency of the rows of C for each redundant row, at the described configuration. In a
    /// sample the rows are independent, or nearly so; the self-stresses of the mechanism that is
    /// meant are those of the described configuration.
    pub(super) dependencies: Vec<Vec<f64>>,
    /// The coefficients of the multipliers for each quantity at the described configuration; empty
    /// for a magnitude.
    pub(super) forms: Vec<Vec<f64>>,
}

/// A request for bounds in each sample.
pub(super) struct SampleBounds {
    /// The described configuration. Its self-stresses are used for all samples.
    pub(super) configuration: Option<Configuration<'static>>,
    /// The scene, which contains the centres of stiffness.
    pub(super) scene: Scene,
    pub(super) elasticity: Elasticity,
}

impl Nominal {
    /// Analyses the mechanism of a scene at time t.
    pub(super) fn new(assembled: AssembledScene, t: f64) -> Result<Self, ToleranceError> {
        let stated = assembled.mechanism.clone();
        let (study, doubt) = study_of(assembled)?;
        let state = study.state_at(t)?;
        let analysed = match &doubt {
            None => Some(study.analyse(t, None)?),
            Some(_) => None,
        };
        let prepared = &study.prepared;
        let mechanism = &prepared.mechanism;
        let layout = mechanism.layout();
        let mut s = mechanism.scratch();
        mechanism.pose(t, &state.q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        let (kept, position_kept) = match &doubt {
            None => (
                prepared.decision.kept.clone(),
                prepared.position_decision.kept.clone(),
            ),
            Some(doubt) => lower_rank(mechanism, &s, &state.q, doubt, prepared)?,
        };
        let quantities = Quantity::all(mechanism);
        let mut verdicts = vec!["undecided"; quantities.len()];
        let mut reactions: Vec<NominalReaction> = layout
            .groups
            .iter()
            .map(|group| NominalReaction {
                name: group.name.clone(),
                kind: group.spec.common.scene_type,
                verdict: "undecided",
                fragile: false,
            })
            .collect();
        if let Some(found) = &analysed {
            for (own, judged) in reactions.iter_mut().zip(&found.analysis.reactions) {
                own.verdict = judged.wrench.verdict.word();
            }
            let fragile = found.sensitivities()?;
            for (ConstraintId(k), _) in fragile.fragile() {
                reactions[k].fragile = true;
            }
            if let Some(decision) = found.analysis.whole() {
                let configuration = Configuration::new(mechanism, t, &state.q, &decision)
                    .map_err(StudyError::from)?;
                for (verdict, quantity) in verdicts.iter_mut().zip(&quantities) {
                    *verdict = quantity.verdict(mechanism, &configuration, 0.0);
                }
            }
        }
        // Without finite reactions no load is permitted.
        let is_solvable = analysed.as_ref().is_none_or(|found| {
            let solution = found.solution();
            solution.is_ok_and(|solution| solution.no_finite.is_empty())
        });
        // The joints set the values of reference points, directions and numbers at the start. The
        // accuracy of these values is the accuracy that the scene states.
        let of_stated = stated.with_numbers(&mechanism.data().numbers());
        let mut at = of_stated.scratch();
        of_stated.pose(prepared.start_time(), &prepared.q, &mut at);
        let data = displaced(&of_stated, of_stated.data().blocks(&at));
        let keeps = prepared.start.keep.iter();
        let keeps = keeps.filter(|c| c.level == KeepLevel::Position && t == prepared.start_time());
        let kept_columns = keeps
            .map(|c| layout.columns(c.body).start + c.dof)
            .collect();
        let missing = (0..layout.m).filter(|i| position_kept.binary_search(i).is_err());
        let mut nominal = Self {
            scene: study.scene.name().to_owned(),
            t,
            kept_columns,
            size: prepared.assembly.size,
            data,
            reading: doubt.map_or(Reading::Decided, |d| Reading::Undecided(d.to_string())),
            rank: kept.len(),
            missing: missing.collect(),
            kept,
            position_kept,
            reactions,
            quantities,
            verdicts,
            bounds: None,
            contacts: None,
            base: Base {
                q: state.q,
                v: state.v,
            },
            mechanism: of_stated,
        };
        if is_solvable {
            nominal.contacts = nominal.sample_contacts();
        }
        Ok(nominal)
    }
}

/// Prepares the study of a scene. If the rank within the tolerances is undecided, returns the study
/// for exact numbers, and a text about the undecided rank.
fn study_of(assembled: AssembledScene) -> Result<(Study, Option<Doubt>), ToleranceError> {
    let (scene, mechanism) = (assembled.scene.clone(), assembled.mechanism.clone());
    let doubt = match assembled.prepare(&RunOptions::default()) {
        Ok(study) => return Ok((study, None)),
        Err(StudyError::Motion(dynamics::MotionError::RankUndecided(doubt))) => doubt,
        Err(other) => return Err(other.into()),
    };
    let exact = AssembledScene {
        scene,
        mechanism: mechanism.without_tolerances(),
    };
    Ok((exact.prepare(&RunOptions::default())?, Some(doubt)))
}

/// Returns independent rows of C and of Φq at the lower of two ranks.
fn lower_rank(
    mechanism: &Mechanism,
    s: &model::Scratch,
    q: &[f64],
    doubt: &Doubt,
    exact: &dynamics::PreparedMechanism,
) -> Result<(Vec<usize>, Vec<usize>), ToleranceError> {
    let (all, holonomic) = (&exact.decision, &exact.position_decision);
    let fewer = match *doubt {
        Doubt::NoClearGap { lower, .. }
        | Doubt::NearUncertainty { lower, .. }
        | Doubt::WithinRounding { lower, .. }
        | Doubt::WithinTolerance { lower, .. }
        | Doubt::OtherPoses { lower, .. } => all.rank.saturating_sub(lower),
        _ => 0,
    };
    let rows = |count: usize, decision: &RowDecision| {
        let rank = decision.rank.saturating_sub(fewer);
        rows_of_rank(mechanism, s, q, (count, rank), None).map(|found| found.kept)
    };
    let undecided = || {
        let error = dynamics::MotionError::RankUndecided(*doubt);
        ToleranceError::Study(error.into())
    };
    let layout = mechanism.layout();
    let kept = rows(layout.rows(), all).map_err(|_| undecided())?;
    // If there are nonholonomic rows, these may be the redundant rows.
    let position_kept = match layout.h {
        0 => kept.clone(),
        _ => holonomic.kept.clone(),
    };
    Ok((kept, position_kept))
}

/// Returns the data with a stated tolerance. Each datum has the stream of its random numbers.
pub(super) fn displaced(mechanism: &Mechanism, blocks: Vec<DataBlock>) -> Vec<DisplacedDatum> {
    let layout = mechanism.layout();
    let own_stream = |block: &DataBlock| block.numbers.start as u64;
    let driven: Vec<Option<usize>> = layout
        .constraint_ids()
        .map(|id| mechanism.driven(id).map(|(joint, _)| joint.0))
        .collect();
    let of_joint = |block: &DataBlock| {
        let joint = driven[block.group]?;
        let same = |other: &&DataBlock| {
            let alike = (other.name, other.unit, other.numbers.len());
            other.group == joint && alike == (block.name, block.unit, block.numbers.len())
        };
        blocks.iter().find(same).map(own_stream)
    };
    let streams: Vec<u64> = (blocks.iter())
        .map(|block| of_joint(block).unwrap_or_else(|| own_stream(block)))
        .collect();
    let all = blocks.iter().zip(streams);
    all.filter_map(|(block, stream)| {
        Some(DisplacedDatum {
            tolerance: block.tolerance?,
            block: block.clone(),
            stream,
        })
    })
    .collect()
}

impl Nominal {
    /// Returns the smallest and the largest tolerance for a unit. Returns `None` if no datum with
    /// this unit is displaced.
    pub(super) fn tolerances(&self, unit: DataUnit) -> Option<[f64; 2]> {
        let own = self.data.iter().filter(|d| d.block.unit == unit);
        own.map(|d| d.tolerance).fold(None, |range, x| {
            let [least, greatest] = range.unwrap_or([x, x]);
            Some([least.min(x), greatest.max(x)])
        })
    }

    /// Whether a quantity is unique in the described mechanism.
    pub(super) fn is_unique(&self, quantity: usize) -> bool {
        self.verdicts[quantity] == "unique"
    }

    /// Estimates the number of values that a sample stores.
    pub(super) fn numbers_of_sample(&self) -> usize {
        let observed = self.mechanism.frames().observed();
        let places = 2 * self.mechanism.bodies().len() + 3 * observed.markers.len();
        // A verdict consists of a pointer and a length.
        let ranges = usize::from(self.bounds.is_some()) + usize::from(self.contacts.is_some());
        let of_reactions = (4 + 2 * ranges) * self.quantities.len() + 2 * self.reactions.len();
        // The last number accounts for the lists themselves.
        of_reactions + places + self.missing.len() + observed.measures.len() + 32
    }

    /// Whether the rank is decided.
    pub(super) fn is_decided(&self) -> bool {
        matches!(self.reading, Reading::Decided)
    }
}
