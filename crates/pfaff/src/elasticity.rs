//! Options of bounds: the joints and drives that give way.

use model::Layout;
use solvability::{ComplianceRange, Elasticity, NominalCompliance};

use crate::choice::{FindReaction, compliances};
use crate::refusal::Refusal;

/// Name of all drives in the list of rigid joints.
const DRIVES: &str = "drives";

/// The options of bounds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BoundsOptions<'o> {
    /// Whether bounds are requested.
    pub(crate) bounds: bool,
    /// Names of joints and drives that do not give way.
    pub(crate) rigid: &'o [String],
    /// Largest ratio of compliances to their nominal values.
    pub(crate) within: Option<f64>,
    /// Nominal compliances.
    pub(crate) compliance: Option<&'o str>,
}

impl BoundsOptions<'_> {
    /// Reads the options; `None` if no bounds are requested.
    ///
    /// # Errors
    /// Names the option that needs another one, the joint that does not exist, or the expected
    /// text.
    pub(crate) fn read(
        &self,
        layout: &Layout,
        reaction: FindReaction<'_>,
    ) -> Result<Option<Elasticity>, Refusal> {
        let refuse = |message: &str| Err(Refusal::input(message.to_owned()));
        if !self.bounds {
            return match (self.rigid, self.within, self.compliance) {
                ([], None, None) => Ok(None),
                ([_, ..], ..) => refuse("--rigid selects joints for --bounds: add --bounds"),
                (_, Some(_), _) => refuse("--within limits compliances for --bounds: add --bounds"),
                _ => refuse(
                    "--compliance states nominal compliances for --bounds: add --bounds --within K",
                ),
            };
        }
        let mut rigid = Vec::new();
        for name in self.rigid {
            if name == DRIVES {
                let is_drive = |id: &model::ConstraintId| layout.groups[id.0].is_drive();
                rigid.extend(layout.constraint_ids().filter(is_drive));
            } else {
                rigid.push(reaction(name)?);
            }
        }
        let within = match (self.within, self.compliance) {
            (None, None) => None,
            (None, Some(_)) => {
                return refuse(
                    "--compliance states nominal compliances: add --within K, the largest ratio to them",
                );
            }
            (Some(factor), _) if !(factor.is_finite() && factor >= 1.0) => {
                let message = format!(
                    "--within is {factor}, need a ratio ≥ 1 of the largest to the smallest compliance"
                );
                return Err(Refusal::input(message));
            }
            (Some(factor), text) => {
                let nominal = text.map(|text| compliances("--compliance", text, reaction));
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
        Ok(Some(Elasticity { rigid, within }))
    }
}
