//! The scalar quantities of a reaction whose ranges are computed: components, and magnitudes of
//! force and torque.

use linalg::kernels::norm;
use model::{ConstraintId, Layout, Mechanism, Reaction, SpaceKind, System};
use solvability::{Configuration, ElasticSolutions, LinearForm};

/// A kind of scalar quantity of a reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The named component of the definition.
    ByName,
    /// A component in ground axes. The value is the index of the component in the space.
    Component(usize),
    /// The magnitude of the force.
    Force,
    /// The magnitude of the torque.
    Torque,
}

/// A scalar quantity of the reaction of a joint or drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantity {
    pub(super) id: ConstraintId,
    pub(super) kind: Kind,
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
}

/// Returns the less favourable of two verdicts.
pub(super) fn worse(one: &'static str, other: &'static str) -> &'static str {
    let severity = |word: &str| match word {
        "unique" => 0,
        "not_unique" => 2,
        _ => 1,
    };
    if severity(other) > severity(one) {
        other
    } else {
        one
    }
}

impl Quantity {
    /// Returns all numbers of all reactions, joint by joint. Sentences describe the first number of
    /// each joint.
    pub(super) fn all(mechanism: &Mechanism) -> Vec<Self> {
        let layout = mechanism.layout();
        layout
            .constraint_ids()
            .flat_map(|id| Self::of(mechanism, id))
            .collect()
    }

    fn of(mechanism: &Mechanism, id: ConstraintId) -> Vec<Self> {
        let group = &mechanism.layout().groups[id.0];
        let space = group.space;
        let components = group.components();
        let of_kind =
            |range: std::ops::Range<usize>| components.iter().filter(|c| range.contains(c)).count();
        let (forces, torques) = (of_kind(space.forces()), of_kind(space.torques()));
        let quantity = |kind, name, unit| Self {
            id,
            kind,
            name,
            unit,
        };
        let mut all = Vec::new();
        if let Some(name) = group.spec.component {
            // The reaction of a drive of an angle is only a torque.
            let unit = if forces > 0 { "N" } else { "N·m" };
            all.push(quantity(Kind::ByName, name, unit));
        }
        if forces > 1 {
            all.push(quantity(Kind::Force, "|F|", "N"));
        }
        if torques > 1 {
            all.push(quantity(Kind::Torque, "|T|", "N·m"));
        }
        for &c in &components {
            let unit = if space.forces().contains(&c) {
                "N"
            } else {
                "N·m"
            };
            all.push(quantity(Kind::Component(c), space.components()[c], unit));
        }
        all
    }

    /// Returns the value of the quantity in a reaction.
    pub(super) fn of_reaction(&self, space: SpaceKind, reaction: &Reaction) -> f64 {
        let mut components = reaction.components(space);
        match self.kind {
            Kind::ByName => reaction.component.unwrap_or(f64::NAN),
            Kind::Component(c) => components.nth(c).unwrap_or(f64::NAN),
            Kind::Force => norm(&reaction.force),
            Kind::Torque => norm(&reaction.torque),
        }
    }

    /// Returns the verdict on the quantity at a configuration. It is the worst verdict of the
    /// components on which the quantity depends. If `within` is above zero, a component counts as
    /// unique if, and only if, the choice changes the component by at most this fraction of its
    /// value.
    pub(super) fn verdict(
        &self,
        mechanism: &Mechanism,
        at: &Configuration<'_>,
        within: f64,
    ) -> &'static str {
        let judged = self.depends_on(mechanism.layout()).into_iter().map(|name| {
            let Ok(form) = at.reactions().component(self.id, name) else {
                return "undecided";
            };
            // The change is relative to the component, because a small component of a shared
            // reaction is also shared.
            let share = at.solvability().combination(form.coefficients());
            match (at.judge(&form), share) {
                (_, Ok(share)) if within > 0.0 && share.margin <= within => "unique",
                (_, Ok(_)) if within > 0.0 => "not_unique",
                (Ok(judged), _) => judged.verdict.word(),
                (Err(_), _) => "undecided",
            }
        });
        judged.fold("unique", worse)
    }

    /// Returns the number as a linear form of the multipliers; `None` for a magnitude.
    pub(super) fn form(&self, at: &Configuration<'_>) -> Option<LinearForm> {
        match self.kind {
            Kind::ByName | Kind::Component(_) => at.reactions().component(self.id, self.name).ok(),
            Kind::Force | Kind::Torque => None,
        }
    }

    /// Returns the smallest and the largest value for elastic joints, NaN without bounds. A
    /// magnitude is at least zero.
    pub(super) fn bounds(
        &self,
        at: &Configuration<'_>,
        found: &ElasticSolutions<'_, '_>,
    ) -> [f64; 2] {
        let names = self.depends_on(at.layout());
        let forms = names
            .into_iter()
            .map(|name| at.reactions().component(self.id, name));
        let Ok(forms) = forms.collect::<Result<Vec<LinearForm>, _>>() else {
            return [f64::NAN; 2];
        };
        match (self.kind, forms.as_slice()) {
            (Kind::ByName | Kind::Component(_), [form]) => match found.bounds(form) {
                Ok(bounds) if bounds.complete => [bounds.lowest, bounds.highest],
                _ => [f64::NAN; 2],
            },
            (_, forms) => match found.largest_magnitude(forms) {
                Ok(most) => [0.0, most],
                Err(_) => [f64::NAN; 2],
            },
        }
    }

    /// Returns the components on which the quantity depends, by name.
    fn depends_on(&self, layout: &Layout) -> Vec<&'static str> {
        let group = &layout.groups[self.id.0];
        let space = group.space;
        let among = |range: std::ops::Range<usize>| {
            let own = group.components().into_iter();
            own.filter(|c| range.contains(c))
                .map(|c| space.components()[c])
                .collect()
        };
        match self.kind {
            Kind::ByName | Kind::Component(_) => vec![self.name],
            Kind::Force => among(space.forces()),
            Kind::Torque => among(space.torques()),
        }
    }
}
