//! The inputs of kernels: which symbol stands for which argument. Symbols are made in a fixed order, because
//! the canonical order of terms follows it.

use std::collections::BTreeMap;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use symbolic::{Derivation, Expr, Graph, Symbol};

use crate::parse::{Definition, Kept, ParamKind};
use crate::vector::Turn;

/// Where a kernel finds an input.
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
    /// A parameter, by the tokens that read it.
    Parameter { access: String },
    /// A value kept from the start, by the tokens that read it.
    Kept { field: String, access: String },
    /// A multiplier.
    Lambda { row: usize },
}

impl Source {
    /// The value as an expression of the kernel; numbers that are always `f64` come with `true`.
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
            Self::Parameter { access } | Self::Kept { access, .. } => {
                access.parse().expect("written by this crate")
            }
        };
        let is_f64 = matches!(self, Self::Parameter { .. } | Self::Kept { .. });
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
    by_name: BTreeMap<String, Expr>,
    pub(crate) slots: Vec<Slot>,
    /// Jets of the functions of time.
    pub(crate) functions: Vec<[Expr; 3]>,
    /// The jet of a drive's motion and the initial value of its measure.
    pub(crate) motion: [Expr; 3],
    pub(crate) measure_0: Expr,
    pub(crate) lambda: Vec<Expr>,
}

const POSE: [&str; 5] = ["x", "y", "angle", "cos", "sin"];
const TWIST: [&str; 3] = ["x", "y", "omega"];

impl Inputs {
    pub(crate) fn new(g: &mut Graph, d: &Definition) -> Self {
        let mut inputs = Self {
            sources: BTreeMap::new(),
            by_name: BTreeMap::new(),
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
        let parameter = |access: String| Source::Parameter { access };
        match kind {
            ParamKind::Point(_) => {
                for (k, c) in ["x", "y"].into_iter().enumerate() {
                    self.add(
                        g,
                        &format!("{name}_{c}"),
                        parameter(format!("self.{name}[{k}]")),
                    );
                }
            }
            ParamKind::Direction(_) => {
                for (k, c) in ["x", "y"].into_iter().enumerate() {
                    let access = format!("self.{name}.xy()[{k}]");
                    self.add(g, &format!("{name}_local_{c}"), parameter(access));
                }
            }
            ParamKind::GroundLine => {
                for (k, c) in ["x", "y"].into_iter().enumerate() {
                    let start = format!("self.{name}.start()[{k}]");
                    self.add(g, &format!("{name}_start_{c}"), parameter(start));
                    let along = format!("self.{name}.along().xy()[{k}]");
                    self.add(g, &format!("{name}_along_{c}"), parameter(along));
                }
            }
            ParamKind::Number(_) if optional => {}
            ParamKind::Number(_) => {
                self.add(g, name, parameter(format!("self.{name}")));
            }
            ParamKind::Numbers(units) => {
                for k in 0..units.len() {
                    self.add(
                        g,
                        &format!("{name}_{k}"),
                        parameter(format!("self.{name}[{k}]")),
                    );
                }
            }
            ParamKind::Function(_) => {
                let index = self.functions.len();
                let jet = self.add_jet(g, name, index);
                self.functions.push(jet);
            }
            ParamKind::Functions(units) => {
                for k in 0..units.len() {
                    let index = self.functions.len();
                    let jet = self.add_jet(g, &format!("{name}_{k}"), index);
                    self.functions.push(jet);
                }
            }
        }
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

    fn add(&mut self, g: &mut Graph, name: &str, source: Source) -> Expr {
        let e = g.symbol(name);
        let symbol = g.as_symbol(e).expect("just made");
        self.sources.insert(symbol, source);
        self.by_name.insert(name.to_owned(), e);
        e
    }

    /// Symbols of a kept value.
    pub(crate) fn kept(&mut self, g: &mut Graph, field: &str, kind: Kept) -> Vec<Expr> {
        match kind {
            Kept::Number => {
                let access = format!("self.{field}");
                vec![self.add(
                    g,
                    field,
                    Source::Kept {
                        field: field.to_owned(),
                        access,
                    },
                )]
            }
            Kept::Vector => ["x", "y"]
                .into_iter()
                .enumerate()
                .map(|(k, c)| {
                    let access = format!("self.{field}[{k}]");
                    let source = Source::Kept {
                        field: field.to_owned(),
                        access,
                    };
                    self.add(g, &format!("{field}_{c}"), source)
                })
                .collect(),
        }
    }

    pub(crate) fn scalar(&self, name: &str) -> Expr {
        self.by_name[name]
    }

    /// Components of a point or a direction.
    pub(crate) fn pair(&self, name: &str) -> [Expr; 2] {
        ["x", "y"].map(|c| match self.by_name.get(&format!("{name}_local_{c}")) {
            Some(&e) => e,
            None => self.by_name[&format!("{name}_{c}")],
        })
    }

    /// Start and direction of a line.
    pub(crate) fn line(&self, name: &str) -> ([Expr; 2], [Expr; 2]) {
        let pair = |part: &str| ["x", "y"].map(|c| self.by_name[&format!("{name}_{part}_{c}")]);
        (pair("start"), pair("along"))
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

    /// What a unit velocity of one degree of freedom of a slot does to its pose.
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

    /// `d/dt` along the motion, with the accelerations left out.
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
