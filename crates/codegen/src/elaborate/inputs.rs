//! The inputs of kernels: which symbol represents which argument. Symbols are created in a fixed
//! order, because the canonical order of terms depends on it.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use symbolic::{Derivation, Expr, Graph, Symbol};

use crate::parse::{Definition, Kept, ParamKind};
use crate::vector::Turn;

/// The location from which a kernel reads an input.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Source {
    /// A field of the pose of a slot.
    Pose { slot: usize, field: &'static str },
    /// A field of the twist of a slot.
    Twist { slot: usize, field: &'static str },
    /// A field of the acceleration of a slot.
    Acceleration { slot: usize, field: &'static str },
    /// A derivative of a function of time.
    Function { index: usize, order: usize },
    /// A parameter, with the tokens that read it.
    Parameter { access: String },
    /// A value kept from the start, with the tokens that read it.
    Kept { field: String, access: String },
    /// A derivative of a computed number, with the tokens that compute it.
    Slope { access: String },
    /// A multiplier.
    Lambda { row: usize },
}

impl Source {
    /// The value as an expression of the kernel; the flag is `true` for numbers that are always
    /// `f64`.
    pub(crate) fn access(&self) -> (TokenStream, bool) {
        let index = Literal::usize_unsuffixed;
        let of_slot = |array: TokenStream, slot: usize, field: &str| {
            let (slot, field) = (index(slot), format_ident!("{field}"));
            quote!(#array[#slot].#field)
        };
        let tokens = match self {
            Self::Pose { slot, field } => of_slot(quote!(x), *slot, field),
            Self::Twist { slot, field } => of_slot(quote!(v), *slot, field),
            Self::Acceleration { slot, field } => of_slot(quote!(a), *slot, field),
            Self::Function { index: k, order } => {
                let (k, order) = (index(*k), index(*order));
                quote!(f[#k][#order])
            }
            Self::Lambda { row } => {
                let row = index(*row);
                quote!(lambda[#row])
            }
            Self::Parameter { access } | Self::Kept { access, .. } | Self::Slope { access } => {
                access.parse().expect("written by this crate")
            }
        };
        let is_f64 = matches!(
            self,
            Self::Parameter { .. } | Self::Kept { .. } | Self::Slope { .. }
        );
        (tokens, is_f64)
    }
}

/// Symbols of one body slot.
pub(crate) struct Slot {
    /// x, y, angle, cos, sin
    pub(crate) pose: [Expr; 5],
    /// x, y, omega
    pub(crate) twist: [Expr; 3],
    /// x, y, angular
    pub(crate) acceleration: [Expr; 3],
}

/// All inputs of the kernels of one definition.
pub(crate) struct Inputs {
    sources: BTreeMap<Symbol, Source>,
    /// Values of each parameter, in the order of its components.
    params: BTreeMap<String, Vec<Expr>>,
    taken: BTreeSet<String>,
    pub(crate) slots: Vec<Slot>,
    /// Jets of the functions of time.
    pub(crate) functions: Vec<[Expr; 3]>,
    /// The jet of a drive's motion and the initial value of its measure.
    pub(crate) motion: [Expr; 3],
    pub(crate) measure_0: Expr,
    pub(crate) lambda: Vec<Expr>,
}

/// Arguments of kernels: an input with one of these names is renamed.
pub(crate) const ARGUMENTS: [&str; 6] = ["x", "v", "a", "f", "lambda", "out"];

const POSE: [&str; 5] = ["x", "y", "angle", "cos", "sin"];
const TWIST: [&str; 3] = ["x", "y", "omega"];

impl Inputs {
    pub(crate) fn new(g: &mut Graph, d: &Definition) -> Self {
        let mut inputs = Self {
            sources: BTreeMap::new(),
            params: BTreeMap::new(),
            taken: ARGUMENTS.map(str::to_owned).into(),
            slots: Vec::new(),
            functions: Vec::new(),
            motion: [g.number(0.0); 3],
            measure_0: g.number(0.0),
            lambda: Vec::new(),
        };
        let zero = g.number(0.0);
        for (slot, name) in d.slots.iter().enumerate() {
            let mut s = Slot {
                pose: [zero; 5],
                twist: [zero; 3],
                acceleration: [zero; 3],
            };
            for (k, field) in POSE.into_iter().enumerate() {
                let symbol = match k {
                    0 | 1 => format!("r_{name}_{field}"),
                    _ => format!("{field}_{name}"),
                };
                s.pose[k] = inputs.add(g, &symbol, Source::Pose { slot, field });
            }
            for (k, field) in TWIST.into_iter().enumerate() {
                let (velocity, acceleration) = match k {
                    2 => (format!("omega_{name}"), format!("alpha_{name}")),
                    _ => (format!("v_{name}_{field}"), format!("a_{name}_{field}")),
                };
                s.twist[k] = inputs.add(g, &velocity, Source::Twist { slot, field });
                s.acceleration[k] =
                    inputs.add(g, &acceleration, Source::Acceleration { slot, field });
            }
            inputs.slots.push(s);
        }
        for p in &d.params {
            inputs.add_param(g, &p.name.to_string(), &p.kind, p.default.is_some());
        }
        let index = inputs.functions.len();
        inputs.motion = inputs.add_jet(g, "motion", index);
        inputs.measure_0 = inputs.add(
            g,
            "measure_0",
            Source::Kept {
                field: "measure_0".into(),
                access: "self.measure_0".into(),
            },
        );
        for row in 0..d.rows.len().max(1) {
            let lambda = inputs.add(g, &format!("lambda_{row}"), Source::Lambda { row });
            inputs.lambda.push(lambda);
        }
        inputs
    }

    fn add_param(&mut self, g: &mut Graph, name: &str, kind: &ParamKind, optional: bool) {
        let values = match kind {
            ParamKind::Point(_) => self.add_numbers(
                g,
                &[
                    (format!("{name}_x"), format!("{name}[0]")),
                    (format!("{name}_y"), format!("{name}[1]")),
                ],
            ),
            ParamKind::Direction(_) => self.add_numbers(
                g,
                &[
                    (format!("{name}_local_x"), format!("{name}.xy()[0]")),
                    (format!("{name}_local_y"), format!("{name}.xy()[1]")),
                ],
            ),
            ParamKind::GroundLine => self.add_numbers(
                g,
                &[
                    (format!("{name}_start_x"), format!("{name}.start()[0]")),
                    (format!("{name}_along_x"), format!("{name}.along().xy()[0]")),
                    (format!("{name}_start_y"), format!("{name}.start()[1]")),
                    (format!("{name}_along_y"), format!("{name}.along().xy()[1]")),
                ],
            ),
            ParamKind::Number(_) if optional => Vec::new(),
            ParamKind::Number(_) => self.add_numbers(g, &[(name.to_owned(), name.to_owned())]),
            ParamKind::Numbers(units) => {
                let components: Vec<_> = (0..units.len())
                    .map(|k| (format!("{name}_{k}"), format!("{name}[{k}]")))
                    .collect();
                self.add_numbers(g, &components)
            }
            ParamKind::Function(_) => vec![self.add_function(g, name)],
            ParamKind::Functions(units) => (0..units.len())
                .map(|k| self.add_function(g, &format!("{name}_{k}")))
                .collect(),
        };
        self.params.insert(name.to_owned(), values);
    }

    /// Creates inputs for pairs of a name and the field that holds the value.
    fn add_numbers(&mut self, g: &mut Graph, components: &[(String, String)]) -> Vec<Expr> {
        components
            .iter()
            .map(|(name, field)| {
                let access = format!("self.{field}");
                self.add(g, name, Source::Parameter { access })
            })
            .collect()
    }

    fn add_function(&mut self, g: &mut Graph, name: &str) -> Expr {
        let jet = self.add_jet(g, name, self.functions.len());
        self.functions.push(jet);
        jet[0]
    }

    fn add_jet(&mut self, g: &mut Graph, name: &str, index: usize) -> [Expr; 3] {
        let mut order = 0;
        [name.to_owned(), format!("{name}_t"), format!("{name}_tt")].map(|name| {
            order += 1;
            self.add(
                g,
                &name,
                Source::Function {
                    index,
                    order: order - 1,
                },
            )
        })
    }

    /// A new input. Different inputs have different names, whatever names the author used: the
    /// component `s_i_x` of a point `s_i` and a length called `s_i_x` are distinguished by an
    /// underscore.
    fn add(&mut self, g: &mut Graph, name: &str, source: Source) -> Expr {
        let mut name = name.to_owned();
        while !self.taken.insert(name.clone()) {
            name.push('_');
        }
        let e = g.symbol(&name);
        let symbol = g.as_symbol(e).expect("just made");
        self.sources.insert(symbol, source);
        e
    }

    /// Symbols of a kept value.
    pub(crate) fn kept(&mut self, g: &mut Graph, field: &str, kind: &Kept) -> Vec<Expr> {
        let components = match kind {
            Kept::Number(_) => vec![(field.to_owned(), format!("self.{field}"))],
            Kept::Vector(_) => vec![
                (format!("{field}_x"), format!("self.{field}[0]")),
                (format!("{field}_y"), format!("self.{field}[1]")),
            ],
        };
        components
            .into_iter()
            .map(|(name, access)| {
                let field = field.to_owned();
                self.add(g, &name, Source::Kept { field, access })
            })
            .collect()
    }

    /// A symbol for a derivative that is not a polynomial; `access` are the tokens that compute it.
    pub(crate) fn slope(&mut self, g: &mut Graph, name: &str, access: String) -> Expr {
        self.add(g, name, Source::Slope { access })
    }

    /// Values of a parameter: one number each, two components of a point or a direction.
    pub(crate) fn values(&self, name: &str) -> &[Expr] {
        &self.params[name]
    }

    /// Components of a point or a direction.
    pub(crate) fn pair(&self, name: &str) -> [Expr; 2] {
        let values = self.values(name);
        [values[0], values[1]]
    }

    /// Start and direction of a line.
    pub(crate) fn line(&self, name: &str) -> ([Expr; 2], [Expr; 2]) {
        let values = self.values(name);
        ([values[0], values[2]], [values[1], values[3]])
    }

    pub(crate) fn source(&self, s: Symbol) -> &Source {
        &self.sources[&s]
    }

    pub(crate) fn turns(&self) -> Vec<Turn> {
        self.slots
            .iter()
            .map(|s| Turn {
                cos: s.pose[3],
                sin: s.pose[4],
                omega: s.twist[2],
            })
            .collect()
    }

    /// The derivation of the pose of a slot along a unit velocity of one degree of freedom.
    pub(crate) fn along_dof(&self, g: &mut Graph, slot: usize, dof: usize) -> Derivation {
        let one = g.number(1.0);
        let [x, y, angle, cos, sin] = self.slots[slot].pose;
        match dof {
            0 => Derivation::new(g, &[(x, one)]),
            1 => Derivation::new(g, &[(y, one)]),
            _ => {
                let minus_sin = g.neg(sin);
                Derivation::new(g, &[(angle, one), (cos, minus_sin), (sin, cos)])
            }
        }
    }

    /// `d/dt` along the motion, without the terms in the accelerations.
    pub(crate) fn time_derivation(&self, g: &mut Graph) -> Derivation {
        let mut images = Vec::new();
        for s in &self.slots {
            let [x, y, angle, cos, sin] = s.pose;
            let [vx, vy, omega] = s.twist;
            let turned = g.mul(sin, omega);
            let minus_sin = g.neg(turned);
            let plus_cos = g.mul(cos, omega);
            images.extend([
                (x, vx),
                (y, vy),
                (angle, omega),
                (cos, minus_sin),
                (sin, plus_cos),
            ]);
        }
        for jet in self.functions.iter().chain([&self.motion]) {
            images.extend([(jet[0], jet[1]), (jet[1], jet[2])]);
        }
        Derivation::new(g, &images)
    }
}
