//! Requests of bounds: the elastic joints and drives, and the assumptions.

use model::reaction::ConstraintGroup;
use model::{BodyRef, ConstraintId, Layout, Mechanism, System};
use scene::{CentreOfStiffness, Scene, WantedBounds};
use serde::Deserialize;
use solvability::{Centres, ComplianceRange, Elasticity, NominalCompliance};

use crate::choice::{FindReaction, compliances};
use crate::refusal::Refusal;

/// Name of all drives in the list of rigid joints.
const DRIVES: &str = "drives";

/// The request of bounds.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
pub struct BoundsOptions {
    /// Also bound reactions for joints of any stiffness
    #[cfg_attr(feature = "command", arg(long))]
    pub bounds: bool,
    /// Joints and drives that count as rigid in --bounds; `drives` names all drives
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "NAMES", value_delimiter = ',')
    )]
    pub rigid: Vec<String>,
    /// Limit the compliances in --bounds to a range from the nominal ones to K times these
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "K", allow_hyphen_values = true)
    )]
    pub within: Option<f64>,
    /// Nominal compliances for --within, as W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds rad/(N·m)); others
    /// do not give way. Default: all equal
    #[cfg_attr(feature = "command", arg(long, value_name = "LIST"))]
    pub compliance: Option<String>,
}

impl BoundsOptions {
    /// Combines these options with the request of the scene. Returns `None` if no bounds are
    /// requested.
    ///
    /// # Errors
    /// Returns an error that names the option that needs another option.
    pub(crate) fn combined(
        &self,
        of_scene: Option<&WantedBounds>,
    ) -> Result<Option<WantedBounds>, Refusal> {
        let Some(of_scene) = of_scene else {
            return self.requested();
        };
        Ok(Some(WantedBounds {
            rigid: match self.rigid.as_slice() {
                [] => of_scene.rigid.clone(),
                own => own.to_vec(),
            },
            within: self.within.or(of_scene.within),
            compliance: (self.compliance.clone()).or_else(|| of_scene.compliance.clone()),
        }))
    }

    /// Returns the request. Returns `None` if no bounds are requested.
    ///
    /// # Errors
    /// Returns an error that names the option that needs another option.
    pub(crate) fn requested(&self) -> Result<Option<WantedBounds>, Refusal> {
        let needed = match (self.rigid.as_slice(), self.within, &self.compliance) {
            _ if self.bounds => None,
            ([_, ..], ..) => Some("--rigid selects joints for --bounds: add --bounds"),
            (_, Some(_), _) => Some("--within limits compliances for --bounds: add --bounds"),
            (_, _, Some(_)) => Some(
                "--compliance states nominal compliances for --bounds: add --bounds --within K",
            ),
            _ => None,
        };
        match needed {
            Some(words) => Err(Refusal::input(words.to_owned())),
            None => Ok(self.bounds.then(|| WantedBounds {
                rigid: self.rigid.clone(),
                within: self.within,
                compliance: self.compliance.clone(),
            })),
        }
    }
}

/// Returns the centres of stiffness of joints at the coordinates q.
pub(crate) fn centres(scene: &Scene, mechanism: &Mechanism, q: &[f64]) -> Centres {
    if scene.centres.is_empty() {
        return Centres::default();
    }
    let v = vec![0.0; mechanism.layout().n_v];
    let place = |centre: &CentreOfStiffness| match centre.body {
        BodyRef::Ground => centre.point,
        BodyRef::Body(body) => mechanism.frames().point(body, centre.point, q, &v).place,
    };
    let groups = &mechanism.layout().groups;
    let each = scene.centres.iter().filter_map(|centre| {
        let id = groups.iter().position(|g| g.name == centre.joint)?;
        Some((ConstraintId(id), place(centre)))
    });
    Centres(each.collect())
}

/// Finds the joints and drives of a request.
///
/// # Errors
/// Names the joint that does not exist, or the expected text.
pub fn elasticity(
    wanted: &WantedBounds,
    layout: &Layout,
    reaction: FindReaction<'_>,
) -> Result<Elasticity, Refusal> {
    let mut rigid = Vec::new();
    for name in &wanted.rigid {
        if name == DRIVES {
            let is_drive = |id: &model::ConstraintId| layout.groups[id.0].is_drive();
            rigid.extend(layout.constraint_ids().filter(is_drive));
        } else {
            rigid.push(reaction(name)?);
        }
    }
    let within = match (wanted.within, &wanted.compliance) {
        (None, None) => None,
        (None, Some(_)) => {
            let message = "nominal compliances are lower limits: add `within`, the largest ratio to these limits";
            return Err(Refusal::input(message.to_owned()));
        }
        (Some(factor), _) if !(factor.is_finite() && factor >= 1.0) => {
            let message = format!(
                "`within` is {factor}, need a ratio ≥ 1 of the largest to the smallest compliance"
            );
            return Err(Refusal::input(message));
        }
        (Some(factor), text) => {
            let nominal = text.as_deref();
            let nominal = nominal.map(|text| compliances("compliance", text, reaction));
            let nominal = nominal.transpose()?.map(|all| {
                let each = all.iter().map(|c| NominalCompliance {
                    reaction: c.reaction,
                    force: c.along[0],
                    moment: c.rotation,
                });
                each.collect()
            });
            Some(ComplianceRange { factor, nominal })
        }
    };
    Ok(Elasticity {
        rigid,
        within,
        ..Elasticity::default()
    })
}

/// States the assumptions of bounds for these joints and drives. The reactions of these joints and
/// drives are not unique.
pub(crate) fn assumption(
    open: &[&ConstraintGroup],
    has_tolerance: bool,
    within: Option<&ComplianceRange>,
) -> String {
    let slips = open.iter().any(|g| !g.rows.nonholonomic.is_empty());
    let holds = open.iter().any(|g| !g.rows.holonomic.is_empty());
    let law = match within {
        None => "any law and however stiff",
        Some(_) => "a linear law",
    };
    let mut text = format!(
        "for joints that fit exactly (no preload, no misfit) and give way only in the direction of the force or \
         moment that they carry, about their reference points, by {law}; bodies are rigid and do not vibrate"
    );
    if let Some(ComplianceRange { factor, nominal }) = within {
        let nominal = match nominal {
            None => "of each other",
            Some(_) => "of the nominal ones",
        };
        text += &format!("; compliances are within a factor of {factor} {nominal}");
    }
    if open.iter().any(|g| g.limits.open_side.is_some()) {
        text += "; one-sided joints stay closed";
    }
    if slips {
        text += "; contacts slip in proportion to their force";
    }
    if slips && holds {
        text += ", and loads change slowly compared with this slip";
    }
    if has_tolerance {
        text += "; misfits within the tolerance cause preload, which the bounds do not contain";
    }
    text
}
