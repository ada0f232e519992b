//! The inputs on which each part of a definition may depend. An error marks the smallest wrong part
//! of the expression, even if the expression uses this part through a `let`.

use symbolic::{Expr, Node};

use super::inputs::Source;
use super::model::Model;

/// A kind of input that is forbidden, and the reason for this.
pub(super) struct Refusal {
    pub(super) bad: fn(&mut Model, Expr) -> bool,
    pub(super) why: &'static str,
}

/// Rules for values stored at the start, and for conditions on the start.
pub(super) const START: &[Refusal] = &[
    Refusal {
        bad: moves,
        why: "a value of the start depends on positions and parameters: velocities are not known yet",
    },
    Refusal {
        bad: of_time,
        why: "a value of the start depends on positions and parameters, not on functions of time",
    },
];

/// Rules for rows of Φ.
pub(super) const PHI: &[Refusal] = &[
    NO_QUOTIENT,
    Refusal {
        bad: moves,
        why: "`phi` depends on a velocity: a constraint on the level of velocities is `psi`",
    },
    Refusal {
        bad: uses_rate,
        why: "`phi` takes a function of time, not its rate: of a function two derivatives are given, and Γ needs both",
    },
];

/// Rules for rows of Ψ·q̇ + ψ.
pub(super) const PSI: &[Refusal] = &[
    NO_QUOTIENT,
    Refusal {
        bad: not_linear,
        why: "`psi` is not linear in the velocities: its form is Ψ·q̇ + ψ with Ψ and ψ free of velocities",
    },
    Refusal {
        bad: uses_second_rate,
        why: "`psi` takes a function of time and its rate: of a function two derivatives are given, and Γ needs one more",
    },
];

/// Rules for the reference point of a reaction. The reference point may contain divisions, because
/// only the kernel of the reference point uses it. However, if the joint transmits a moment about
/// the reference point, the kernel of this moment must be a polynomial.
pub(super) const PLACE: &[Refusal] = &[
    Refusal {
        bad: moves,
        why: "a place depends on positions and parameters, not on velocities",
    },
    Refusal {
        bad: of_time,
        why: "a place depends on positions and parameters, not on functions of time",
    },
];

/// Rules for the direction of a named component of a reaction.
pub(super) const COMPONENT: &[Refusal] = &[
    NO_QUOTIENT,
    Refusal {
        bad: moves,
        why: "the direction of a component depends on positions and parameters, not on velocities",
    },
    Refusal {
        bad: uses_second_rate,
        why: "the direction of a component takes no second rates of functions of time",
    },
];

/// Rules for the joint coordinate that a drive prescribes.
pub(super) const MEASURE: &[Refusal] = &[
    NO_QUOTIENT,
    Refusal {
        bad: moves,
        why: "a measure is a relative position or angle, not a velocity",
    },
    Refusal {
        bad: of_time,
        why: "a measure depends on positions and parameters, not on functions of time",
    },
];

/// Rules for the coordinate along which a force does work.
pub(super) const COORDINATE: &[Refusal] = &[Refusal {
    bad: moves,
    why: "a force acts on a relative position or angle, not on a velocity: write `force: law on coordinate;` and put \
          the velocity into the law",
}];

/// Rules for a coordinate along which a force does work, or for a velocity. The power of the force
/// depends on this velocity, which is linear in the velocities of the bodies: Q = law·∂velocity/∂v.
pub(super) const COORDINATE_OR_RATE: &[Refusal] = &[Refusal {
    bad: not_linear,
    why: "a force acts on a relative position, or on a velocity that is linear in those of the bodies",
}];

/// Rules for the arguments of `rate` and `velocity`.
pub(super) const DIFFERENTIABLE: &[Refusal] = &[
    Refusal {
        bad: moves,
        why: "this contains a velocity already, and accelerations are not known to a definition",
    },
    Refusal {
        bad: uses_second_rate,
        why: "of a function of time two derivatives are given, not a third",
    },
];

const NO_QUOTIENT: Refusal = Refusal {
    bad: not_polynomial,
    why: "constraint kernels are polynomials: no quotient and no `norm` here; put what depends on parameters and the \
          start only into `initial`, and write a distance as `dot(d, d) - length * length`",
};

/// Returns whether an expression contains a velocity.
pub(super) fn moves(model: &mut Model, e: Expr) -> bool {
    model.depends_on(e, |s| matches!(s, Source::Twist { .. }))
}

fn of_time(model: &mut Model, e: Expr) -> bool {
    model.depends_on(e, |s| matches!(s, Source::Function { .. }))
}

fn uses_rate(model: &mut Model, e: Expr) -> bool {
    model.depends_on(e, |s| matches!(s, Source::Function { order: 1.., .. }))
}

fn uses_second_rate(model: &mut Model, e: Expr) -> bool {
    model.depends_on(e, |s| matches!(s, Source::Function { order: 2.., .. }))
}

fn not_linear(model: &mut Model, e: Expr) -> bool {
    let slots = model.inputs.slots.iter();
    let twists: Vec<Expr> = slots.flat_map(|s| s.twist.iter().copied()).collect();
    twists.into_iter().any(|v| {
        let slope = model.inputs.partial(&mut model.g, v).apply(&mut model.g, e);
        moves(model, slope)
    })
}

fn not_polynomial(model: &mut Model, e: Expr) -> bool {
    let e = model.expand(e);
    let mut seen = std::collections::BTreeSet::new();
    let mut stack = vec![e];
    while let Some(e) = stack.pop() {
        if !seen.insert(e) {
            continue;
        }
        let polynomial = match model.g.node(e) {
            Node::Call(..) => false,
            Node::Product(_, factors) => factors.iter().all(|f| f.1 > 0),
            _ => true,
        };
        if !polynomial {
            return true;
        }
        stack.extend(model.g.children(e));
    }
    false
}
