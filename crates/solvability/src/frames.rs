//! Components of reactions in the frames that engineers use. The frames are global axes, axes of
//! the first body, and axes along and across an edge. Components that are coupled in one frame may
//! be independent in another frame. For example, the bearing force of a crank has a unique
//! component across the crank, even if no global component is unique.

use model::{Axes, ConstraintId, Frame, Mechanism};
use rank::RankDecision;

use crate::groups::{Configuration, LinearForm, ReactionForms, RequestError};
use crate::judged::ComponentVerdict;

/// A reaction in one frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FrameVerdict {
    /// The frame.
    pub frame: Frame,
    /// Unit vectors of the axes of the frame, in global components.
    pub axes: Axes,
    /// Verdicts on the components along the axes, and on the torque about the reference point of
    /// the joint. The names are listed by [`model::SpaceKind::components_in`]. A component that is
    /// identically zero is unique.
    pub components: Vec<ComponentVerdict>,
}

/// The components of a reaction in one frame, as linear forms of the multipliers.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameForms {
    /// Unit vectors of the axes, in global components.
    pub axes: Axes,
    /// The components with their names, in the order of [`FrameVerdict`].
    pub components: Vec<(&'static str, LinearForm)>,
}

/// Determines the verdicts on the reaction of a joint or drive at time t and coordinates q, in all
/// frames of this reaction.
///
/// ```
/// use joints::Revolute;
/// use model::{Body, BodyRef, ConstraintId, Description, Frame, Joint, Mechanism};
/// use pfaff_solvability::{certify, judge_frames};
/// // A beam on two hinges, turned by 30°: the pull along the beam is not determined.
/// let hinge = |name: &str, x: f64, angle: f64| {
///     let at = [x * angle.cos(), x * angle.sin()];
///     let pair = [BodyRef::Body(0), BodyRef::Ground];
///     Joint::new(name, &pair, Revolute { s_i: [x, 0.0], s_j: at })
/// };
/// let angle = 30_f64.to_radians();
/// let beam = Description {
///     bodies: vec![Body { name: "beam".into(), mass: 1.0, inertia: 1.0, angle, ..Body::default() }],
///     joints: vec![hinge("left", -1.0, angle), hinge("right", 1.0, angle)],
///     ..Description::default()
/// };
/// let mechanism = Mechanism::build(&beam).unwrap();
/// let q = [0.0, 0.0, angle];
/// let decision = certify(&mechanism, 0.0, &q).unwrap();
/// let verdicts = judge_frames(&mechanism, 0.0, &q, &decision, ConstraintId(0)).unwrap();
/// let words = |k: usize| [0, 1, 2].map(|c| verdicts[k].components[c].judgement.verdict.word());
/// assert_eq!((verdicts[0].frame, words(0)), (Frame::Global, ["not_unique", "not_unique", "unique"]));
/// assert_eq!((verdicts[1].frame, words(1)), (Frame::FirstBody, ["not_unique", "unique", "unique"]));
/// ```
///
/// # Errors
/// Returns the same errors as [`Configuration::new`], and [`RequestError::UnknownReaction`].
pub fn judge_frames(
    mechanism: &Mechanism,
    t: f64,
    q: &[f64],
    decision: &RankDecision,
    id: ConstraintId,
) -> Result<Vec<FrameVerdict>, RequestError> {
    Configuration::new(mechanism, t, q, decision)?.frames(id)
}

impl Configuration<'_> {
    /// Returns the verdicts on a reaction in all of its frames.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`]: the mechanism does not contain the joint or drive.
    pub fn frames(&self, id: ConstraintId) -> Result<Vec<FrameVerdict>, RequestError> {
        let mut verdicts = Vec::new();
        for frame in Frame::ALL {
            let Some(FrameForms { axes, components }) = self.reactions.in_frame(id, frame)? else {
                continue;
            };
            let judged = components.iter().map(|(name, form)| {
                let judgement = self.judge(form)?;
                Ok(ComponentVerdict { name, judgement })
            });
            verdicts.push(FrameVerdict {
                frame,
                axes,
                components: judged.collect::<Result<_, RequestError>>()?,
            });
        }
        Ok(verdicts)
    }
}

impl ReactionForms<'_> {
    /// Returns the components of a reaction in a frame, or `None` if the reaction has no such
    /// frame.
    ///
    /// # Errors
    /// [`RequestError::UnknownReaction`]: the mechanism does not contain the joint or drive.
    pub fn in_frame(
        &self,
        id: ConstraintId,
        frame: Frame,
    ) -> Result<Option<FrameForms>, RequestError> {
        let place = self.place(id)?;
        let Some(axes) = self.mechanism.reactions(&self.s).axes(id, frame) else {
            return Ok(None);
        };
        let space = self.mechanism.space();
        let mut forms = Vec::new();
        for along in axes.iter() {
            forms.push(self.force(id, *along)?);
        }
        match space.n_rotations() {
            // In the plane, the direction of a torque is z in all axes.
            1 => forms.push(self.torque(id, [0.0, 0.0, 1.0], place)?),
            _ => {
                for along in axes.iter() {
                    forms.push(self.torque(id, *along, place)?);
                }
            }
        }
        let names = space.components_in(frame).iter().copied();
        let components = names.zip(forms).collect();
        Ok(Some(FrameForms { axes, components }))
    }
}

#[cfg(test)]
mod tests;
