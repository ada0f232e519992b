//! An equilibrium: the distance from the start, the residual forces, and the reactions at the
//! equilibrium.

use crate::documents::{
    LoadsDocument, PullDocument, SensitivityDocument, VerdictDocument, loads_at,
};
use dynamics::equilibrium::{Equilibrium, RestStability};
use linalg::kernels::norm;
use model::{Layout, Mechanism, SpaceKind, System};
use report::ByName;
use serde::Serialize;
use solvability::{ReactionValues, ReactionVerdict, Sensitivities, Value};

use crate::study::Study;

/// Reactions, and the contacts that pull.
pub(super) type Reactions = (ByName<ReactionAtRest>, Vec<PullDocument>);

/// An equilibrium of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EquilibriumAnswer {
    /// Name of the scene.
    pub scene: String,
    /// Time at which functions of time were evaluated (s).
    pub time: f64,
    /// Steps of the search.
    pub steps: usize,
    /// Number of perturbations that left unstable equilibria.
    pub pushes: usize,
    /// Residual force along free motions, as a fraction of the largest force.
    pub residual: f64,
    /// The largest force, or torque divided by the size of the mechanism (N).
    pub largest_force: f64,
    /// `immovable`, `stable`, `idle`, `unstable` or `not_judged`.
    pub stability: &'static str,
    /// Reason why the stability is not analysed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_judged_because: Option<&'static str>,
    /// Position of each body, and its distance from the start.
    pub bodies: ByName<RestingBody>,
    /// Free motions without driving force and without restoring force.
    pub idle: Vec<String>,
    /// Free motions along which forces drive the mechanism away.
    pub falling: Vec<String>,
    /// Whether the equilibrium depends on the path to it, because of nonholonomic rows.
    pub depends_on_way: bool,
    /// Drives, locked at their positions at that time, with zero rate and acceleration.
    pub held: Vec<String>,
    /// Locked drives and joints that functions of time would accelerate immediately.
    pub moving_on: Vec<String>,
    /// Reactions of joints and drives at the equilibrium.
    pub reactions: ByName<ReactionAtRest>,
    /// Reason why there are no values of reactions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_reactions_because: Option<String>,
    /// Contacts that pull, although they are not described as one-sided.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pulls: Vec<PullDocument>,
    /// Loads of force elements on their first bodies (N, N·m), with lengths (m) and angles (rad).
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub loads: LoadsDocument,
    /// Scene file that starts at the equilibrium.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<&'static str>,
    /// Text of the scene file.
    #[serde(skip)]
    pub text_at_rest: String,
}

/// A body at the equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RestingBody {
    /// Distance of the origin of the frame from the start (m).
    pub moved: f64,
    /// Angle of the rotation from the start (rad); in the plane with its sign.
    pub turned: f64,
    /// Position of the frame: the columns of a trajectory, without velocities.
    pub at: ByName<f64>,
}

/// A reaction at the equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ReactionAtRest {
    /// Verdict on the reaction.
    #[serde(flatten)]
    pub verdict: VerdictDocument,
    /// Sensitivity of the reaction to the data.
    #[serde(flatten)]
    pub data: SensitivityDocument,
    /// Components of force and torque on the first body (N, N·m) that are not identically zero.
    pub values: ByName<Value>,
}

impl ReactionAtRest {
    /// Returns the documents of all reactions of an analysed configuration, with their names.
    pub(super) fn all(
        verdicts: &[ReactionVerdict],
        values: &[ReactionValues],
        sensitivities: &Sensitivities,
        layout: &Layout,
    ) -> ByName<Self> {
        let one = |(verdict, values): (&ReactionVerdict, &ReactionValues)| {
            let numbers = values.components.iter();
            let numbers = numbers.map(|(name, value)| ((*name).to_owned(), value.clone()));
            let document = Self {
                verdict: (&verdict.wrench).into(),
                data: SensitivityDocument::of(sensitivities, verdict.id, layout),
                values: ByName(numbers.collect()),
            };
            (values.name.clone(), document)
        };
        ByName(verdicts.iter().zip(values).map(one).collect())
    }
}

impl EquilibriumAnswer {
    /// Builds the answer of a study, with its reactions at the equilibrium while functions of time
    /// have constant values, or the reason why there are no reactions.
    pub(super) fn new(study: &Study, x: &Equilibrium, there: Result<Reactions, String>) -> Self {
        let (mechanism, start) = (&study.prepared.mechanism, &study.prepared.q);
        let bodies = (0..mechanism.bodies().len()).map(|body| {
            let name = mechanism.bodies()[body].name.clone();
            (name, resting(mechanism, body, start, &x.q))
        });
        let groups = &mechanism.layout().groups;
        let drives = groups.iter().filter(|group| group.is_drive());
        let ((reactions, pulls), no_reactions_because) = match there {
            Ok(found) => (found, None),
            Err(why) => (Reactions::default(), Some(why)),
        };
        Self {
            scene: study.scene.name().to_owned(),
            time: x.time,
            steps: x.steps,
            pushes: x.pushes,
            residual: x.residual,
            largest_force: x.largest_force,
            stability: x.stability.word(),
            not_judged_because: RestStability::why_not(x.stability),
            bodies: ByName(bodies.collect()),
            idle: x.idle.clone(),
            falling: x.falling.clone(),
            depends_on_way: x.depends_on_way,
            held: drives.map(|group| group.name.clone()).collect(),
            moving_on: x.moving_on.clone(),
            reactions,
            no_reactions_because,
            pulls,
            loads: loads_at(mechanism, x.time, &x.q, &vec![0.0; mechanism.layout().n_v]),
            file: None,
            text_at_rest: String::new(),
        }
    }
}

fn resting(mechanism: &Mechanism, body: usize, start: &[f64], q: &[f64]) -> RestingBody {
    let space = mechanism.space();
    let v = vec![0.0; space.n_v() * mechanism.bodies().len()];
    let [from, to] = [start, q].map(|q| mechanism.frames().body(body, q, &v));
    let way: [f64; 3] = std::array::from_fn(|k| to.place[k] - from.place[k]);
    let turned = match space {
        SpaceKind::Space3 => {
            let turned = mechanism.difference_of(q, start);
            norm(&turned[space.rotations_of(body)])
        }
        _ => to.angle - from.angle,
    };
    let places = space.columns().len() - space.n_v();
    let places = space.columns().iter().zip(to.numbers()).take(places);
    RestingBody {
        moved: norm(&way),
        turned,
        at: ByName(places.map(|(name, x)| ((*name).to_owned(), x)).collect()),
    }
}
