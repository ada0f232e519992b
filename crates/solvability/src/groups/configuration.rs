//! A mechanism at a configuration with a decided rank. The configuration returns verdicts on the
//! numbers of its reactions.

use crate::pose::{dimensionless, evaluated, uncertainty};
use std::borrow::Cow;

use model::start::scene_size;
use model::{Layout, Mechanism, Scratch, System};
use rank::RankDecision;

use super::error::{RequestError, check};
use super::form::LinearForm;
use super::reactions::ReactionForms;
use crate::error::AnalysisError;
use crate::matrices::Solvability;
use crate::verdict::Judgement;

/// A mechanism at time t and coordinates q, and the rank of C at this configuration.
pub struct Configuration<'a> {
    pub(crate) reactions: ReactionForms<'a>,
    pub(crate) solvability: Solvability,
}

impl<'a> Configuration<'a> {
    /// Combines a mechanism with the configuration at which `decision` was made.
    ///
    /// # Errors
    /// - [`RequestError::Length`]: q, or the decision, belongs to another mechanism.
    /// - [`RequestError::NotFinite`]: t or q is not finite.
    pub fn new(
        mechanism: &'a Mechanism,
        t: f64,
        q: &[f64],
        decision: &RankDecision,
    ) -> Result<Self, RequestError> {
        Self::of(Cow::Borrowed(mechanism), t, q, decision)
    }

    /// Works like [`Self::new`], with a copy of the mechanism.
    ///
    /// # Errors
    /// Returns the same errors as [`Self::new`].
    pub fn owned(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        decision: &RankDecision,
    ) -> Result<Configuration<'static>, RequestError> {
        Configuration::of(Cow::Owned(mechanism.clone()), t, q, decision)
    }

    /// Decides the rank of C at a configuration, like [`crate::decide`]. If another configuration
    /// of the same motion is given, its decision is carried to this configuration, provided that
    /// its kept rows show the same rank here ([`rank::carried`]).
    ///
    /// # Errors
    /// - [`AnalysisError::Rank`]: C is not finite.
    pub fn decided(
        mechanism: &'a Mechanism,
        (t, q): (f64, &[f64]),
        near: Option<&Self>,
    ) -> Result<Self, AnalysisError> {
        let s = evaluated(mechanism, t, q);
        let size = near.map_or_else(|| scene_size(mechanism, q), Self::size);
        let c = dimensionless(mechanism, &s, size);
        let carried = near.and_then(|near| rank::carried(near.solvability.decision(), &c));
        let decision = match carried {
            Some(decision) => decision,
            None => rank::decide(&c, &uncertainty(mechanism, &s, size))
                .map_err(|source| AnalysisError::Rank { time: t, source })?,
        };
        Ok(Self {
            reactions: ReactionForms {
                mechanism: Cow::Borrowed(mechanism),
                s: Cow::Owned(s),
                size,
            },
            solvability: Solvability::from_decision(&c, decision),
        })
    }

    /// Works like [`Self::new`], but takes ownership of the mechanism.
    pub(crate) fn of(
        mechanism: Cow<'a, Mechanism>,
        t: f64,
        q: &[f64],
        decision: &RankDecision,
    ) -> Result<Self, RequestError> {
        let layout = mechanism.layout();
        check("t", &[t], 1)?;
        check("q", q, layout.n_q)?;
        let scaling = &decision.scaling;
        let shape = [
            (
                "the rank decision, by rows,",
                scaling.rows.len(),
                layout.rows(),
            ),
            (
                "the rank decision, by columns,",
                scaling.cols.len(),
                layout.n_v,
            ),
        ];
        for (argument, found, expected) in shape {
            if found != expected {
                return Err(RequestError::Length {
                    argument,
                    found,
                    expected,
                });
            }
        }
        let s = evaluated(&mechanism, t, q);
        let size = scene_size(&mechanism, q);
        let c = dimensionless(&mechanism, &s, size);
        Ok(Self {
            reactions: ReactionForms {
                mechanism,
                s: Cow::Owned(s),
                size,
            },
            solvability: Solvability::from_decision(&c, decision.clone()),
        })
    }

    /// Returns the reaction components as linear forms of the multipliers.
    #[must_use]
    pub fn reactions(&self) -> &ReactionForms<'a> {
        &self.reactions
    }

    /// Returns the scratch with Φ and C at the configuration.
    #[must_use]
    pub fn scratch(&self) -> &Scratch {
        &self.reactions.s
    }

    /// Returns the size of the mechanism at the configuration (m).
    #[must_use]
    pub fn size(&self) -> f64 {
        self.reactions.size
    }

    /// Returns the rows and columns of the mechanism.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        self.reactions.mechanism.layout()
    }

    /// Returns the solvability of the multipliers.
    #[must_use]
    pub fn solvability(&self) -> &Solvability {
        &self.solvability
    }

    /// Returns the verdict on a number.
    ///
    /// # Errors
    /// [`RequestError::Length`]: the form belongs to another mechanism.
    pub fn judge(&self, form: &LinearForm) -> Result<Judgement, RequestError> {
        form.judge(&self.solvability)
    }
}
