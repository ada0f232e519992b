//! The inputs of kernels: the symbol for each argument. Symbols are created in a fixed order,
//! because the canonical order of terms depends on the order of the symbols.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use symbolic::{Expr, Graph, Symbol};

use crate::defined::{Along, Defined};
use crate::parse::{Definition, Kept, ParamKind};
use crate::space::{AXES, Space};
use crate::vector::{Components, Turn, cross};

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
    /// A value of an unwrapped angle: the angle, its cosine or its sine. The value is passed at the
    /// position of a function of time.
    Counted { index: usize },
    /// A parameter, with the tokens of the expression that reads it.
    Parameter { access: String },
    /// A value stored at the start, with the tokens of the expression that reads it.
    Kept { field: String, access: String },
    /// A multiplier.
    Lambda { row: usize },
}

impl Source {
    /// Returns the value as an expression in the kernel. The flag is `true` for values that are
    /// always `f64`.
    pub(crate) fn access(&self) -> (TokenStream, bool) {
        let index = Literal::usize_unsuffixed;
        let of_slot = |array: TokenStream, slot: usize, field: &str| {
            let slot = index(slot);
            let field: TokenStream = field.parse().expect("a field of a pose or twist");
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
            Self::Counted { index: k } => {
                let k = index(*k);
                quote!(f[#k][0])
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
    /// Inputs in the order of [`Space::pose`].
    pub(crate) pose: Vec<Expr>,
    /// Inputs in the order of [`Space::twist`]; the inputs of `acceleration` have the same order.
    pub(crate) twist: Vec<Expr>,
    pub(crate) acceleration: Vec<Expr>,
}

/// All inputs of the kernels of one definition.
pub(crate) struct Inputs {
    pub(crate) space: Space,
    sources: BTreeMap<Symbol, Source>,
    /// The values of each parameter, in the order of the components of the parameter.
    params: BTreeMap<String, Vec<Expr>>,
    taken: BTreeSet<String>,
    pub(crate) slots: Vec<Slot>,
    /// Vectors and products in space that are differentiated as a whole.
    pub(crate) defined: Defined,
    /// Jets of the functions of time.
    pub(crate) functions: Vec<[Expr; 3]>,
    /// The jet of the motion of a drive, and the initial value of its joint coordinate.
    pub(crate) motion: [Expr; 3],
    pub(crate) measure_0: Expr,
    /// The jets of the cosine and the sine of the motion, and the cosine and sine of the initial
    /// angle. The jets are used for angles in space.
    pub(crate) motion_turn: [[Expr; 3]; 2],
    pub(crate) turn_0: [Expr; 2],
    pub(crate) lambda: Vec<Expr>,
}

/// Names of arguments of kernels. An input with one of these names is renamed.
pub(crate) const ARGUMENTS: [&str; 6] = ["x", "v", "a", "f", "lambda", "out"];

impl Inputs {
    pub(crate) fn new(g: &mut Graph, d: &Definition) -> Self {
        let zero = g.number(0.0);
        let mut inputs = Self {
            space: d.space,
            sources: BTreeMap::new(),
            params: BTreeMap::new(),
            taken: ARGUMENTS.map(str::to_owned).into(),
            slots: Vec::new(),
            defined: Defined::default(),
            functions: Vec::new(),
            motion: [zero; 3],
            measure_0: zero,
            motion_turn: [[zero; 3]; 2],
            turn_0: [zero; 2],
            lambda: Vec::new(),
        };
        for (slot, name) in d.slots.iter().enumerate() {
            let of_slot = |symbol: &str| symbol.replace("{}", &name.to_string());
            let mut s = Slot {
                pose: Vec::new(),
                twist: Vec::new(),
                acceleration: Vec::new(),
            };
            for &(field, symbol) in d.space.pose() {
                let source = Source::Pose { slot, field };
                s.pose.push(inputs.add(g, &of_slot(symbol), source));
            }
            for &(field, [velocity, acceleration]) in d.space.twist() {
                let source = Source::Twist { slot, field };
                s.twist.push(inputs.add(g, &of_slot(velocity), source));
                let source = Source::Acceleration { slot, field };
                let a = inputs.add(g, &of_slot(acceleration), source);
                s.acceleration.push(a);
            }
            inputs.slots.push(s);
        }
        if d.space == Space::Space3 {
            let slots = inputs.slots.iter();
            inputs.defined = Defined::new(slots.map(rotation).collect());
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
        if d.space == Space::Space3 {
            inputs.motion_turn = [("motion_cos", index), ("motion_sin", index + 1)]
                .map(|(name, index)| inputs.add_jet(g, name, index));
            inputs.turn_0 = ["cos", "sin"].map(|part| {
                let k = usize::from(part == "sin");
                let field = "measure_0".to_owned();
                let access = format!("self.measure_0[{k}]");
                inputs.add(g, &format!("{part}_0"), Source::Kept { field, access })
            });
        }
        for row in 0..d.rows.len().max(1) {
            let lambda = inputs.add(g, &format!("lambda_{row}"), Source::Lambda { row });
            inputs.lambda.push(lambda);
        }
        inputs
    }

    fn add_param(&mut self, g: &mut Graph, name: &str, kind: &ParamKind, optional: bool) {
        let axes = &AXES[..self.space.dim()];
        let values = match kind {
            ParamKind::Point(_) => {
                let numbers = axes.iter().enumerate();
                let numbers: Vec<_> = numbers
                    .map(|(k, axis)| (format!("{name}_{axis}"), format!("{name}[{k}]")))
                    .collect();
                self.add_numbers(g, &numbers)
            }
            ParamKind::Direction(_) => {
                let parts = axes.concat();
                let numbers = axes.iter().enumerate();
                let numbers: Vec<_> = numbers
                    .map(|(k, axis)| {
                        let local = format!("{name}_local_{axis}");
                        (local, format!("{name}.{parts}()[{k}]"))
                    })
                    .collect();
                self.add_numbers(g, &numbers)
            }
            ParamKind::Axes { .. } => {
                let numbers: Vec<_> = (0..9)
                    .map(|n| {
                        let (row, k) = (n / 3, n % 3);
                        let symbol = format!("{name}_local_{}{}", ["u", "v", "w"][row], AXES[k]);
                        (symbol, format!("{name}.uvw()[{row}][{k}]"))
                    })
                    .collect();
                self.add_numbers(g, &numbers)
            }
            ParamKind::GroundLine => self.add_numbers(
                g,
                &[
                    (format!("{name}_start_x"), format!("{name}.start()[0]")),
                    (format!("{name}_along_x"), format!("{name}.along().xy()[0]")),
                    (format!("{name}_start_y"), format!("{name}.start()[1]")),
                    (format!("{name}_along_y"), format!("{name}.along().xy()[1]")),
                ],
            ),
            ParamKind::GroundPlane => {
                let point = AXES.iter().enumerate().map(|(k, axis)| {
                    (
                        format!("{name}_point_{axis}"),
                        format!("{name}.point()[{k}]"),
                    )
                });
                let normal = AXES.iter().enumerate().map(|(k, axis)| {
                    let access = format!("{name}.normal().xyz()[{k}]");
                    (format!("{name}_normal_{axis}"), access)
                });
                let along = AXES.iter().enumerate().map(|(k, axis)| {
                    let access = format!("{name}.along().xyz()[{k}]");
                    (format!("{name}_along_{axis}"), access)
                });
                let numbers: Vec<_> = point.chain(normal).chain(along).collect();
                self.add_numbers(g, &numbers)
            }
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

    /// Creates inputs for pairs. Each pair consists of a name and the field that contains the
    /// value.
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

    /// Creates an input. Different inputs have different names, whatever names the author used. For
    /// example, an underscore distinguishes the component `s_i_x` of a point `s_i` from a length
    /// with the name `s_i_x`.
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

    /// Creates the symbols of a value stored at the start.
    pub(crate) fn kept(&mut self, g: &mut Graph, field: &str, kind: &Kept) -> Vec<Expr> {
        let components = match kind {
            Kept::Number(_) => vec![(field.to_owned(), format!("self.{field}"))],
            Kept::Vector(_) => {
                let axes = AXES[..self.space.dim()].iter().enumerate();
                axes.map(|(k, axis)| (format!("{field}_{axis}"), format!("self.{field}[{k}]")))
                    .collect()
            }
            Kept::Turn => {
                let parts = ["cos", "sin"].iter().enumerate();
                parts
                    .map(|(k, part)| (format!("{field}_{part}"), format!("self.{field}[{k}]")))
                    .collect()
            }
        };
        components
            .into_iter()
            .map(|(name, access)| {
                let field = field.to_owned();
                self.add(g, &name, Source::Kept { field, access })
            })
            .collect()
    }

    /// Creates the values of the unwrapped angle with index `k`: the angle since the start, its
    /// cosine and its sine. In the arguments of kernels, these values come after the functions of
    /// time.
    pub(crate) fn counted(&mut self, g: &mut Graph, name: &str, k: usize) -> [Expr; 3] {
        let first = self.functions.len() + 3 * k;
        [
            (first, "known"),
            (first + 1, "known_cos"),
            (first + 2, "known_sin"),
        ]
        .map(|(index, part)| self.add(g, &format!("{name}_{part}"), Source::Counted { index }))
    }

    /// Returns the values of a parameter: one value for a scalar, and two components for a point or
    /// a direction.
    pub(crate) fn values(&self, name: &str) -> &[Expr] {
        &self.params[name]
    }

    /// Returns the start and the direction of a line.
    pub(crate) fn line(&self, name: &str) -> (Components, Components) {
        let values = self.values(name);
        (vec![values[0], values[2]], vec![values[1], values[3]])
    }

    /// Returns the components of the directions u, v and w of a parameter of axes.
    pub(crate) fn axes(&self, name: &str) -> [Components; 3] {
        let values = self.values(name);
        [0, 1, 2].map(|k| values[3 * k..3 * k + 3].to_vec())
    }

    /// Returns whether the input with this name is the cosine (`part` 0) or the sine (`part` 1) of
    /// the motion of a drive.
    pub(crate) fn is_motion_turn(&self, name: &str, part: usize) -> bool {
        self.space == Space::Space3
            && name.trim_end_matches('_') == ["motion_cos", "motion_sin"][part]
    }

    pub(crate) fn source(&self, s: Symbol) -> &Source {
        &self.sources[&s]
    }

    pub(crate) fn turns(&self) -> Vec<Turn> {
        let slots = self.slots.iter().enumerate();
        slots.map(|(slot, s)| self.turn(slot, s)).collect()
    }

    fn turn(&self, slot: usize, s: &Slot) -> Turn {
        match self.space {
            Space::Plane => Turn::Plane {
                cos: s.pose[3],
                sin: s.pose[4],
                omega: s.twist[2],
            },
            Space::Space3 => Turn::Space3 {
                slot,
                omega: [s.twist[3], s.twist[4], s.twist[5]],
                defined: self.defined.clone(),
            },
        }
    }

    /// Returns the derivation of the pose of a slot along a unit velocity of one degree of freedom.
    pub(crate) fn along_dof(&self, g: &mut Graph, slot: usize, dof: usize) -> Along {
        let (zero, one) = (g.number(0.0), g.number(1.0));
        let mut velocity = vec![zero; self.space.n_dof()];
        velocity[dof] = one;
        let images = self.pose_rates(g, slot, &velocity);
        let images: Vec<_> = images.into_iter().filter(|i| !g.is_zero(i.1)).collect();
        let still = vec![zero; 3];
        let mut spins = vec![
            still;
            if self.space == Space::Space3 {
                self.slots.len()
            } else {
                0
            }
        ];
        if let Some(spin) = spins.get_mut(slot) {
            *spin = velocity[3..].to_vec();
        }
        Along::new(g, &self.defined, &images, spins)
    }

    /// Returns the derivation with these images of inputs that are not poses.
    pub(crate) fn derivation(&self, g: &Graph, images: &[(Expr, Expr)]) -> Along {
        Along::new(g, &self.defined, images, Vec::new())
    }

    /// Returns the partial derivative with respect to an input that is not a pose.
    pub(crate) fn partial(&self, g: &mut Graph, by: Expr) -> Along {
        let one = g.number(1.0);
        self.derivation(g, &[(by, one)])
    }

    /// Returns each coordinate of the pose of the body in a slot, with its rate for these
    /// velocities.
    fn pose_rates(&self, g: &mut Graph, slot: usize, v: &[Expr]) -> Vec<(Expr, Expr)> {
        let s = &self.slots[slot];
        let dim = self.space.dim();
        let mut rates: Vec<Expr> = v[..dim].to_vec();
        match self.turn(slot, s) {
            Turn::Plane { cos, sin, .. } => {
                let omega = v[dim];
                let turned = g.mul(sin, omega);
                let minus_sin = g.neg(turned);
                let plus_cos = g.mul(cos, omega);
                rates.extend([omega, minus_sin, plus_cos]);
            }
            // R·[ω]×: the rows of R are vectors in the frame of the body.
            Turn::Space3 { .. } => {
                for row in rotation(s) {
                    rates.extend(cross(g, &row, &v[dim..]));
                }
            }
        }
        s.pose.iter().copied().zip(rates).collect()
    }

    /// Returns `d/dt` along the motion, without the acceleration terms.
    pub(crate) fn time_derivation(&self, g: &mut Graph) -> Along {
        let images = self.rates(g);
        Along::new(g, &self.defined, &images, self.time_spins()).in_time()
    }

    /// Returns `d/dt` along the motion, with the acceleration terms.
    pub(crate) fn full_time_derivation(&self, g: &mut Graph) -> Along {
        let mut images = self.rates(g);
        for s in &self.slots {
            images.extend(s.twist.iter().copied().zip(s.acceleration.iter().copied()));
        }
        Along::new(g, &self.defined, &images, self.time_spins()).in_time()
    }

    fn time_spins(&self) -> Vec<Components> {
        match self.space {
            Space::Plane => Vec::new(),
            Space::Space3 => self.slots.iter().map(|s| s.twist[3..].to_vec()).collect(),
        }
    }

    /// Returns the rates of poses and functions of time.
    fn rates(&self, g: &mut Graph) -> Vec<(Expr, Expr)> {
        let mut images = Vec::new();
        for slot in 0..self.slots.len() {
            images.extend(self.pose_rates(g, slot, &self.slots[slot].twist));
        }
        let motion = [&self.motion].into_iter().chain(match self.space {
            Space::Plane => &[][..],
            Space::Space3 => &self.motion_turn,
        });
        for jet in self.functions.iter().chain(motion) {
            images.extend([(jet[0], jet[1]), (jet[1], jet[2])]);
        }
        images
    }
}

/// Returns R of a slot in space, by rows.
fn rotation(s: &Slot) -> [[Expr; 3]; 3] {
    [0, 1, 2].map(|row| [0, 1, 2].map(|k| s.pose[3 + 3 * row + k]))
}
