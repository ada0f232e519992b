//! Parts that constraints and forces have in common: the type, its constructor, and the values
//! stored at the start.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use symbolic::{Expr, Scalar};

use super::constructors;
use crate::data::Datum;
use crate::elaborate::{Comparison, Condition, Counted, KeptValue, Measure, Model};
use crate::kernel::kernel;
use crate::names::kebab_case;
use crate::parse::{Definition, Kept, Param, ParamKind};
use crate::space::Space;

/// The differences between a constraint and the drives of its joint coordinates.
pub(super) struct Type {
    pub(super) name: Ident,
    pub(super) rows: Vec<String>,
    pub(super) doc: Vec<String>,
    pub(super) component: Option<String>,
    pub(super) drives: Vec<Drive>,
    /// The way in which the drive moves its joint coordinate; `None` for a joint.
    pub(super) driven: Option<Driven>,
    pub(super) scene_type: String,
    pub(super) data: Vec<Datum>,
    /// Number of angles that the kernels receive including full revolutions.
    pub(super) turns: usize,
    /// The angles whose cosine, sine and rate the type returns. The angles are the unwrapped
    /// angles, or the joint coordinate that the drive moves.
    pub(super) counted: Vec<Counted>,
}

/// The type of a drive.
#[derive(Clone)]
pub(super) struct Drive {
    pub(super) measure: Ident,
    pub(super) name: Ident,
    pub(super) by: Driven,
}

/// The method by which a drive moves its joint coordinate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Driven {
    /// The drive has a separate row.
    Measure,
    /// The drive has a separate row for an angle in space, by cosine and sine.
    Turn,
    /// The drive has the rows of the joint, and replaces the joint.
    Rows,
}

pub(super) fn scene_type(d: &Definition) -> String {
    match &d.scene {
        Some(name) => name.value(),
        None => kebab_case(&d.name.to_string()),
    }
}

/// Returns the imports that the generated items need.
pub(super) fn uses(runtime: &TokenStream, space: Space, constraint: bool) -> TokenStream {
    let (traits, specs) = if constraint {
        (
            match space {
                Space::Plane => {
                    quote!(
                        Constraint,
                        ConstraintKernels,
                        Definition,
                        Element,
                        Programs,
                        Reaction,
                        Real,
                        Scalar,
                        Visitor
                    )
                }
                Space::Space3 => quote!(
                    Constraint,
                    ConstraintKernels,
                    Definition,
                    Element,
                    Programs,
                    Reaction,
                    Real,
                    Scalar,
                    Space3,
                    Visitor
                ),
            },
            quote!(
                ConstraintSpec,
                Datum,
                DatumShape,
                Entry,
                Measure,
                Parameter,
                Role,
                Row,
                Shape,
                Spec,
                Unit,
                Variant
            ),
        )
    } else {
        (
            match space {
                Space::Plane => quote!(Definition, Force, ForceElement, Real),
                Space::Space3 => quote!(Definition, Force, ForceElement, Real, Space3),
            },
            quote!(ForceSpec, Parameter, Shape, Spec, Unit, Variant),
        )
    };
    let kinematics = match space {
        Space::Plane => quote!(plane::{Direction, Line, Pose, Twist}),
        Space::Space3 => quote!(space3::{Axes, Direction, GroundPlane, Pose, Twist}),
    };
    let std = constraint.then(|| {
        quote!(
            use std::sync::OnceLock;
        )
    });
    quote! {
        #std
        #[allow(unused_imports)]
        use #runtime::{#traits};
        #[allow(unused_imports)]
        use #runtime::arguments::{Argument, ArgumentError, Reader};
        #[allow(unused_imports)]
        use #runtime::#kinematics;
        #[allow(unused_imports)]
        use #runtime::spec::{#specs};
    }
}

/// Returns the type with its fields.
pub(super) fn structure(
    d: &Definition,
    model: &Model,
    name: &Ident,
    doc: &[String],
    driven: Option<Driven>,
) -> TokenStream {
    let doc: Vec<String> = doc.iter().map(|line| format!(" {line}")).collect();
    let params = d.params.iter().filter_map(|p| {
        let (name, ty) = (&p.name, field_type(d.space, p)?);
        let doc = param_doc(p, d);
        Some(quote!(#[doc = #doc] pub #name: #ty,))
    });
    let kept = model.kept.iter().map(|k| {
        let name = format_ident!("{}", k.field);
        let ty = match k.kind {
            Kept::Number(_) => quote!(f64),
            Kept::Vector(_) => vector(d.space),
            Kept::Turn => quote!([f64; 2]),
        };
        let doc = match &k.overridden_by {
            Some(p) => format!(" `{p}`, or its value at the assembled start; set by `initialise`."),
            None if k.kind == Kept::Turn => {
                " Cosine and sine of the angle at the assembled start; set by `initialise`."
                    .to_owned()
            }
            None => " Kept from the assembled start; set by `initialise`.".to_owned(),
        };
        quote!(#[doc = #doc] #name: #ty,)
    });
    let measure = match driven {
        Some(Driven::Measure) => Some(quote! {
            #[doc = " Value of the measure at the assembled start; set by `initialise`."]
            measure_0: f64,
        }),
        Some(Driven::Turn) => Some(quote! {
            #[doc = " Cosine and sine of the measure at the assembled start; set by `initialise`."]
            measure_0: [f64; 2],
        }),
        Some(Driven::Rows) | None => None,
    };
    let constructors = constructors::constructors(d, model, name, driven);
    quote! {
        #(#[doc = #doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct #name {
            #(#params)*
            #(#kept)*
            #measure
        }

        #constructors
    }
}

/// Returns the drives of a joint with its parameters: one method for each joint coordinate. The
/// result is empty if there is no joint coordinate.
pub(super) fn drives(
    d: &Definition,
    model: &Model,
    name: &Ident,
    drives: &[Drive],
) -> Option<TokenStream> {
    let params = d.params.iter().filter(|p| field_type(d.space, p).is_some());
    let fields: Vec<Ident> = params
        .map(|p| p.name.clone())
        .chain(model.kept.iter().map(|k| format_ident!("{}", k.field)))
        .collect();
    let methods = drives.iter().map(|Drive { measure, name, by }| {
        let measure_0 = measure_0(*by);
        let doc = format!(" The drive of its {measure}, with the same parameters.");
        let method = format_ident!("{measure}_drive");
        quote! {
            #[doc = #doc]
            #[must_use]
            pub fn #method(&self) -> #name {
                #name { #(#fields: self.#fields,)* #measure_0 }
            }
        }
    });
    let methods: Vec<_> = methods.collect();
    (!methods.is_empty()).then(|| quote!(impl #name { #(#methods)* }))
}

/// Returns the purpose of a parameter, followed by its kind.
fn param_doc(p: &Param, d: &Definition) -> String {
    let slot = |s: &Ident| match d.slots.len() {
        1 => "the body".to_owned(),
        _ => format!("body {s}"),
    };
    let unit = |unit: &Ident| format!("[`Unit::{unit}`]");
    let takes = match &p.kind {
        ParamKind::Point(s) => format!("Point in the frame of {} (m).", slot(s)),
        ParamKind::Direction(s) => format!("Unit vector in the frame of {}.", slot(s)),
        ParamKind::Axes { slot: s, .. } => format!(
            "Axis, and directions across it, in the frame of {}.",
            slot(s)
        ),
        ParamKind::GroundLine => "Line of the ground.".to_owned(),
        ParamKind::GroundPlane => "Plane of the ground, z = 0 unless it is given.".to_owned(),
        ParamKind::Number(u) | ParamKind::Function(u) => format!("Unit: {}.", unit(u)),
        ParamKind::Numbers(u) | ParamKind::Functions(u) => {
            let units: Vec<_> = u.iter().map(unit).collect();
            format!("Units: {}.", units.join(", "))
        }
    };
    if p.doc.is_empty() {
        format!(" {takes}")
    } else {
        format!(" {} {takes}", p.doc.join(" "))
    }
}

/// Returns the type of the field of a parameter. Functions of time are not fields, because they are
/// passed as jets.
pub(super) fn field_type(space: Space, p: &Param) -> Option<TokenStream> {
    Some(match &p.kind {
        ParamKind::Point(_) => vector(space),
        ParamKind::Direction(_) => quote!(Direction),
        ParamKind::Axes { .. } => quote!(Axes),
        ParamKind::GroundLine => quote!(Line),
        ParamKind::GroundPlane => quote!(GroundPlane),
        ParamKind::Number(_) if p.default.is_some() => quote!(Option<f64>),
        ParamKind::Number(_) => quote!(f64),
        ParamKind::Numbers(units) => {
            let n = index(units.len());
            quote!([f64; #n])
        }
        ParamKind::Function(_) | ParamKind::Functions(_) => return None,
    })
}

/// Returns the type of the components of a vector.
pub(super) fn vector(space: Space) -> TokenStream {
    let dim = index(space.dim());
    quote!([f64; #dim])
}

/// Returns the field of the initial joint coordinate, before the start is assembled.
pub(super) fn measure_0(by: Driven) -> Option<TokenStream> {
    match by {
        Driven::Measure => Some(quote!(measure_0: 0.0)),
        Driven::Turn => Some(quote!(measure_0: [1.0, 0.0])),
        Driven::Rows => None,
    }
}

/// Returns an integer literal without suffix.
pub(crate) fn index(k: usize) -> proc_macro2::Literal {
    proc_macro2::Literal::usize_unsuffixed(k)
}

/// Returns the index of a slot.
pub(super) fn slot(d: &Definition, name: &Ident) -> proc_macro2::Literal {
    let slot = d.slots.iter().position(|s| s == name);
    index(slot.expect("checked while elaborating"))
}

/// Returns the constructor that takes checked arguments.
pub(super) fn from_arguments(d: &Definition, driven: Option<Driven>) -> TokenStream {
    let mut reads: Vec<TokenStream> = d
        .params
        .iter()
        .map(|p| {
            let name = &p.name;
            match &p.kind {
                ParamKind::Point(_) => match d.space {
                    Space::Plane => quote!(let #name = reader.point()?;),
                    Space::Space3 => quote!(let #name = reader.point3()?;),
                },
                ParamKind::Direction(_) => match d.space {
                    Space::Plane => quote!(let #name = reader.direction()?;),
                    Space::Space3 => quote!(let #name = reader.direction3()?;),
                },
                ParamKind::Axes { .. } => quote!(let #name = reader.axes()?;),
                ParamKind::GroundLine => quote!(let #name = reader.line()?;),
                ParamKind::GroundPlane => quote!(let #name = reader.ground_plane()?;),
                ParamKind::Number(_) if p.default.is_some() => {
                    quote!(let #name = reader.optional_number()?;)
                }
                ParamKind::Number(_) => quote!(let [#name] = reader.numbers()?;),
                ParamKind::Numbers(_) => quote!(let #name = reader.numbers()?;),
                ParamKind::Function(_) | ParamKind::Functions(_) => quote!(reader.skip();),
            }
        })
        .collect();
    if driven.is_some() {
        reads.push(quote!(reader.skip();));
    }
    let stored = || d.params.iter().filter(|p| field_type(d.space, p).is_some());
    let required = stored().filter(|p| p.default.is_none()).map(|p| &p.name);
    let given: Vec<_> = stored()
        .filter(|p| p.default.is_some())
        .map(|p| &p.name)
        .collect();
    let new = quote!(Self::new(#(#required),*));
    let new = if given.is_empty() {
        new
    } else {
        quote!(Self { #(#given,)* ..#new })
    };
    // Without parameters, only the number of arguments is checked.
    let reader = if reads.is_empty() {
        quote!(Reader::new(Self::SPEC.common.parameters, arguments)?;)
    } else {
        quote!(let mut reader = Reader::new(Self::SPEC.common.parameters, arguments)?;)
    };
    quote! {
        fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError> {
            #reader
            #(#reads)*
            Ok(#new)
        }
    }
}

/// Returns the method that computes the values stored at the start. Each value may use the earlier
/// values.
pub(super) fn initialise(model: &Model, measure: Option<Measure>) -> Option<TokenStream> {
    let kept = model.kept.iter().map(|k| {
        let field = format_ident!("{}", k.field);
        if k.kind == Kept::Turn {
            return unit_turn(model, &field, &k.values);
        }
        let value = kept_value(model, k);
        match &k.overridden_by {
            Some(p) if let Some(number) = literal(&value) => {
                quote!(self.#field = self.#p.unwrap_or(#number);)
            }
            Some(p) => quote! {
                self.#field = match self.#p {
                    Some(given) => given,
                    None => #value
                };
            },
            None => quote!(self.#field = #value;),
        }
    });
    let measure = measure.map(|measure| match measure {
        Measure::Of(e) => {
            let printed = kernel(model, &[e], Scalar::F64);
            let (statements, outputs) = (&printed.statements, &printed.outputs);
            quote!(self.measure_0 = { #(#statements)* #(#outputs)* };)
        }
        Measure::Angle { sin, cos } => unit_turn(model, &format_ident!("measure_0"), &[cos, sin]),
        Measure::Kept(_) => TokenStream::new(),
    });
    let keeps = !model.kept.is_empty() || measure.as_ref().is_some_and(|m| !m.is_empty());
    keeps.then(|| {
        quote! {
            fn initialise(&mut self, x: &[Pose]) { #(#kept)* #measure }
        }
    })
}

/// Returns statements that store the cosine and sine of an angle. The computed values are divided
/// by their length √(cos² + sin²), because the axes may be only nearly parallel.
fn unit_turn(model: &Model, field: &Ident, turn: &[Expr]) -> TokenStream {
    let printed = kernel(model, turn, Scalar::F64);
    let (statements, outputs) = (&printed.statements, &printed.outputs);
    quote! {
        let [c, s]: [f64; 2] = { #(#statements)* [#(#outputs),*] };
        // If the axes are perpendicular, the angle is undefined, and any value is valid.
        let length = c.hypot(s);
        self.#field = if length > 0.0 { [c / length, s / length] } else { [1.0, 0.0] };
    }
}

/// Returns the method that computes the cosine, the sine and the rate of each unwrapped angle. The
/// result is `None` if there is no such angle.
pub(super) fn turned(model: &Model, counted: &[Counted]) -> Option<TokenStream> {
    if counted.is_empty() {
        return None;
    }
    let arms = counted.iter().enumerate().map(|(k, of_angle)| {
        let printed = kernel(model, &of_angle.all(), Scalar::F64);
        let (k, statements, outputs) = (index(k), &printed.statements, &printed.outputs);
        quote!(#k => { #(#statements)* [#(#outputs),*] })
    });
    Some(quote! {
        fn turned(&self, k: usize, x: &[Pose], v: &[Twist]) -> [f64; 3] {
            match k { #(#arms)* _ => [1.0, 0.0, 0.0] }
        }
    })
}

/// Returns the literal of a block that contains only a literal.
fn literal(block: &TokenStream) -> Option<syn::ExprLit> {
    let block: syn::Block = syn::parse2(block.clone()).ok()?;
    match block.stmts.as_slice() {
        [syn::Stmt::Expr(syn::Expr::Lit(literal), None)] => Some(literal.clone()),
        _ => None,
    }
}

/// Returns the block that computes a stored value.
pub(super) fn kept_value(model: &Model, k: &KeptValue) -> TokenStream {
    let printed = kernel(model, &k.values, Scalar::F64);
    let (statements, outputs) = (&printed.statements, &printed.outputs);
    match k.kind {
        Kept::Number(_) => quote!({ #(#statements)* #(#outputs)* }),
        Kept::Vector(_) | Kept::Turn => quote!({ #(#statements)* [#(#outputs),*] }),
    }
}

/// Returns the method that checks requirement `k`.
pub(super) fn requirement(model: &Model) -> Option<TokenStream> {
    let arms = model.requirements.iter().enumerate().map(|(k, condition)| {
        let mut scalars = Vec::new();
        collect(condition, &mut scalars);
        let printed = kernel(model, &scalars, Scalar::F64);
        let test = print_condition(condition, &mut printed.outputs.iter());
        let (k, statements) = (index(k), &printed.statements);
        quote!(#k => { #(#statements)* #test })
    });
    let method = quote! {
        fn requirement(&self, k: usize, x: &[Pose]) -> bool { match k { #(#arms)* _ => true } }
    };
    (!model.requirements.is_empty()).then_some(method)
}

/// Returns the method that lists the points at which the definition acts.
pub(super) fn points(d: &Definition) -> Option<TokenStream> {
    let points = d.params.iter().filter_map(|p| match p.kind {
        ParamKind::Point(_) => Some(&p.name),
        _ => None,
    });
    let points: Vec<&Ident> = points.collect();
    let vector = vector(d.space);
    (!points.is_empty()).then(|| {
        quote! {
            fn points(&self) -> Vec<#vector> { vec![#(self.#points),*] }
        }
    })
}

/// Returns the method that gives the axes of a joint in space; `None` if the first body of the
/// joint has no axes.
pub(super) fn axes(d: &Definition) -> Option<TokenStream> {
    let first = d.slots.first().filter(|_| d.space == Space::Space3)?;
    let axes = d
        .params
        .iter()
        .find_map(|Param { name, kind, .. }| match kind {
            ParamKind::Axes { slot, .. } if slot == first => Some(quote!(Some(self.#name.uvw()))),
            ParamKind::Direction(slot) if slot == first => {
                Some(quote!(Axes::new(self.#name.xyz(), None).map(Axes::uvw)))
            }
            _ => None,
        })?;
    Some(quote! {
        fn axes(&self) -> Option<[[f64; 3]; 3]> { #axes }
    })
}

/// Returns the method that gives the axes of both bodies that a joint in space keeps parallel. The
/// axes are the axes of one parameter, and the axes that follow it with `like`. The result is
/// `None` if there are no such axes.
pub(super) fn parallel_axes(d: &Definition) -> Option<TokenStream> {
    let [first, second] = d.slots.first_chunk()?;
    let of = |name: &Ident| d.params.iter().find(|p| p.name == *name);
    let is_of_first = |p: &Param| matches!(&p.kind, ParamKind::Axes { slot, .. } if slot == first);
    let [a, b] = d.params.iter().find_map(|p| match &p.kind {
        ParamKind::Axes {
            slot,
            like: Some(like),
            ..
        } if slot == second && of(like).is_some_and(is_of_first) => Some([like, &p.name]),
        _ => None,
    })?;
    Some(quote! {
        fn parallel_axes(&self) -> Option<[[[f64; 3]; 3]; 2]> {
            Some([self.#a.uvw(), self.#b.uvw()])
        }
    })
}

fn collect(c: &Condition, out: &mut Vec<Expr>) {
    match c {
        Condition::Compare(_, a, b) => out.extend([*a, *b]),
        Condition::And(a, b) | Condition::Or(a, b) => {
            collect(a, out);
            collect(b, out);
        }
    }
}

fn print_condition<'a>(
    c: &Condition,
    scalars: &mut impl Iterator<Item = &'a TokenStream>,
) -> TokenStream {
    match c {
        Condition::Compare(comparison, ..) => {
            let (a, b) = (scalars.next(), scalars.next());
            match comparison {
                Comparison::Equal => quote!(#a == #b),
                Comparison::NotEqual => quote!(#a != #b),
                Comparison::Greater => quote!(#a > #b),
                Comparison::Less => quote!(#a < #b),
            }
        }
        Condition::And(a, b) => {
            // `&&` has a higher precedence than `||`.
            let mut operand = |c: &Condition| {
                let printed = print_condition(c, scalars);
                match c {
                    Condition::Or(..) => quote!((#printed)),
                    _ => printed,
                }
            };
            let (a, b) = (operand(a), operand(b));
            quote!(#a && #b)
        }
        Condition::Or(a, b) => {
            let (a, b) = (print_condition(a, scalars), print_condition(b, scalars));
            quote!(#a || #b)
        }
    }
}
