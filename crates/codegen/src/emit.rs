//! Prints the text of a generated module: the type, its specification and its kernels.

mod constructors;
mod data;
mod facts;
mod parts;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use symbolic::{Counts, Expr, Program, Scalar};

use crate::data::{derivations, of_measure, of_turn, stored};
use crate::derive::{self, Component, ConstraintKernels, Sparse};
use crate::elaborate::{Body, ConstraintBody, Counted, Measure, Model};
use crate::kernel::{Kernel, kernel, rows};
use crate::names::camel_case;
use crate::parse::Definition;
use crate::space::Space;
use data::Stored;
use parts::{Driven, Type};

/// Returns the module of a constraint: its type, and one type for the drive of each joint
/// coordinate.
pub(crate) fn constraint(
    d: &Definition,
    mut model: Model,
    runtime: &TokenStream,
    text: &str,
) -> syn::Result<TokenStream> {
    let body = std::mem::replace(&mut model.body, Body::Force(Vec::new()));
    let Body::Constraint(body) = body else {
        unreachable!("elaborated as a constraint")
    };
    let component = match body.component {
        Some(_) => Component::Along,
        None => Component::None,
    };
    let idle = |at: &[TokenStream], row: usize| {
        syn::Error::new_spanned(&at[row], "no velocity changes this: it restricts no motion")
    };
    let data = stored(d, &model);
    let by_data = derivations(&mut model, &data);
    let kernels =
        derive::constraint(&mut model, &body, &component).map_err(|row| idle(&body.at, row))?;
    let drive = |(name, measure): &(Ident, Measure)| parts::Drive {
        measure: name.clone(),
        name: format_ident!("{}{}Drive", d.name, camel_case(&name.to_string())),
        by: match measure {
            Measure::Of(_) => Driven::Measure,
            Measure::Angle { .. } => Driven::Turn,
            Measure::Kept(_) => Driven::Rows,
        },
    };
    let drives: Vec<parts::Drive> = body.measures.iter().map(drive).collect();
    for (
        k,
        parts::Drive {
            measure,
            name: driver,
            ..
        },
    ) in drives.iter().enumerate()
    {
        if drives[..k].iter().any(|other| other.name == *driver) {
            return Err(syn::Error::new_spanned(
                measure,
                format!("two measures would have the drive `{driver}`: choose another name"),
            ));
        }
    }
    let main = Type {
        name: d.name.clone(),
        rows: d.rows.iter().map(ToString::to_string).collect(),
        doc: d.doc.clone(),
        component: body.component.as_ref().map(|(name, _)| name.to_string()),
        drives: drives.clone(),
        driven: None,
        scene_type: parts::scene_type(d),
        data: data.clone(),
        turns: model.counted.len(),
        counted: model.counted.clone(),
    };
    let stored = Stored::of(&mut model, &kernels, &by_data);
    let mut driven_types = Vec::new();
    let motion = model.inputs.motion[0];
    for (drive, (measure, value)) in drives.iter().zip(&body.measures) {
        let (rows, at) = match *value {
            Measure::Of(value) => {
                let terms = [(1.0, value), (-1.0, model.inputs.measure_0), (-1.0, motion)];
                (vec![model.g.sum(&terms)], vec![quote!(#measure)])
            }
            Measure::Angle { sin, cos } => {
                (vec![turned(&mut model, [cos, sin])], vec![quote!(#measure)])
            }
            Measure::Kept(kept) => {
                let moved = model.g.add(kept, motion);
                let of_joint = body.rows.iter();
                let rows = of_joint.map(|&row| {
                    let row = model.expand(row);
                    model.g.substitute(row, &[(kept, moved)])
                });
                (rows.collect(), body.at.clone())
            }
        };
        let driven = ConstraintBody {
            holonomic: match drive.by {
                Driven::Measure | Driven::Turn => rows.len(),
                Driven::Rows => body.holonomic,
            },
            rows,
            vectors: Vec::new(),
            at,
            place: body.place.clone(),
            component: None,
            measures: vec![(measure.clone(), *value)],
        };
        let mut by_data = by_data.clone();
        let own = match drive.by {
            Driven::Measure => Some(of_measure(&model, format_ident!("Length"))),
            Driven::Turn => Some(of_turn(&model)),
            Driven::Rows => None,
        };
        if let Some(own) = &own {
            by_data.extend(derivations(&mut model, std::slice::from_ref(own)));
        }
        let component = Component::Motion(match drive.by {
            Driven::Turn => {
                let [cos, sin] = model.inputs.motion_turn.map(|jet| jet[0]);
                let minus = model.g.neg(sin);
                let images = [(cos, minus), (sin, cos)];
                model.inputs.derivation(&model.g, &images)
            }
            Driven::Measure | Driven::Rows => model.inputs.partial(&mut model.g, motion),
        });
        let own_kernels = derive::constraint(&mut model, &driven, &component)
            .map_err(|row| idle(&driven.at, row))?;
        let stored = Stored::of(&mut model, &own_kernels, &by_data);
        let mut data = data.clone();
        let (rows, doc) = match drive.by {
            Driven::Measure => {
                data.push(of_measure(&model, own_kernels.unit_of_measure(d.space)));
                (
                    vec![measure.to_string()],
                    "a function of time: measure − initial measure − f(t) = 0",
                )
            }
            Driven::Turn => {
                data.extend(own);
                (
                    vec![measure.to_string()],
                    "a function of time: sin(measure − initial measure − f(t)) = 0",
                )
            }
            Driven::Rows => (
                main.rows.clone(),
                "its initial value + f(t): the rows of the joint with this value, in their place",
            ),
        };
        let counted = match *value {
            Measure::Angle { sin, cos } => {
                let start = model.inputs.turn_0;
                let since = model.angle_since([cos, sin], start).all();
                let [cos, sin, rate] = since.map(|e| model.expand(e));
                vec![Counted { cos, sin, rate }]
            }
            Measure::Of(_) | Measure::Kept(_) => Vec::new(),
        };
        let drive = Type {
            name: drive.name.clone(),
            rows,
            doc: vec![format!("The {measure} of `{}` follows {doc}.", d.name)],
            component: Some("drive".to_owned()),
            drives: Vec::new(),
            driven: Some(drive.by),
            scene_type: measure.to_string(),
            data,
            turns: 0,
            counted,
        };
        let mut driven = driven;
        driven.measures[0].1 = expanded(&mut model, *value);
        driven_types.push((drive, own_kernels, stored, driven));
    }
    let driven = driven_types
        .iter()
        .map(|(t, kernels, stored, body)| (t, kernels, stored, body));
    let types: Vec<_> = std::iter::once((&main, &kernels, &stored, &body))
        .chain(driven)
        .collect();
    let blocks = types
        .iter()
        .flat_map(|(_, kernels, ..)| derivatives(kernels));
    let operations = |block: &Sparse| Program::new(&model.g, &values(block)).counts().total();
    let is_long = blocks.map(|(.., block)| operations(block)).sum::<usize>() > MOST_OPERATIONS;
    let items = types.into_iter().map(|(t, kernels, stored, body)| {
        constraint_type(d, &model, t, (kernels, stored, is_long), body, text)
    });
    let uses = parts::uses(runtime, d.space, true);
    Ok(quote!(#uses #(#items)*))
}

/// Maximum number of operations of the closed-form derivatives of a definition and its drives. For
/// longer derivatives, dual numbers are used, which need no compilation and take little more time.
/// The derivatives of mesh, screw and universal have 10 to 20 thousand operations and were a sixth
/// of all generated lines. The derivatives of cylindrical are the next longest and have 6500
/// operations.
const MOST_OPERATIONS: usize = 8000;

/// Returns the derivatives of rows with respect to poses and velocities.
fn derivatives(k: &ConstraintKernels) -> [(&'static str, &'static str, Signature, &Sparse); 4] {
    use Signature::{Force, Rate, Residual};
    [
        ("d_force_dx", "∂(Cᵀλ)/∂x", Force, &k.d_force_dx),
        ("d_residual_dx", "∂(C·a − Γ)/∂x", Residual, &k.d_residual_dx),
        ("d_gamma_dv", "∂Γ/∂v", Rate, &k.d_gamma_dv),
        ("d_velocity_dx", "∂(C·v − b)/∂x", Rate, &k.d_velocity_dx),
    ]
}

fn constraint_type(
    d: &Definition,
    model: &Model,
    t: &Type,
    (k, stored, is_long): (&ConstraintKernels, &Stored, bool),
    body: &ConstraintBody,
    text: &str,
) -> TokenStream {
    let name = &t.name;
    let structure = parts::structure(d, model, name, &t.doc, t.driven);
    let spec = facts::constraint_spec(d, t, k, body, text);
    let from_arguments = parts::from_arguments(d, t.driven);
    let measure = t.driven.map(|_| body.measures[0].1);
    let initialise = parts::initialise(model, measure);
    let requirement = parts::requirement(model);
    let turned = parts::turned(model, &t.counted);
    let points = parts::points(d);
    let axes = parts::axes(d);
    // A drive has the parameters of its joint, but not its rows.
    let parallel_axes = match t.driven {
        None => parts::parallel_axes(d),
        Some(_) => None,
    };
    let data = data::methods(model, &t.data);
    let drives = parts::drives(d, model, name, &t.drives);
    let visits = t.drives.iter();
    let visits = visits.map(|parts::Drive { name, .. }| quote!(visitor.drive::<#name>();));

    let row = |name, what, outputs: &[Expr], s| {
        method(name, what, rows(model, outputs, &stored.symbols), s)
    };
    let phi = row("phi", "Φ", &k.phi, Signature::Position);
    let (constants, varying): (Vec<_>, Vec<_>) =
        k.c.iter().enumerate().partition(|(_, e)| e.constant);
    let entries = |name, what, entries: &[(usize, &derive::Entry)], arguments| {
        indexed(
            name,
            what,
            entries,
            |outputs| rows(model, outputs, &stored.symbols),
            arguments,
        )
    };
    let what = "Constant entries of C";
    let c_constant = (!constants.is_empty()).then(|| entries("c_constant", what, &constants, None));
    let c = entries(
        "c",
        "Varying entries of C",
        &varying,
        Some(quote!(x: &[Pose<T>], f: &[[T; 3]],)),
    );
    let some = |k: &[Expr]| !k.is_empty();
    let b = some(&k.b).then(|| row("b", "b", &k.b, Signature::Position));
    let gamma = row("gamma", "Γ", &k.gamma, Signature::Velocity);
    let what = "Coefficients of the named component";
    let component =
        some(&k.component).then(|| row("component", what, &k.component, Signature::Position));
    let wrench = kernel(model, &values(&k.wrench), Scalar::Generic);
    let wrench = method(
        "wrench",
        "Entries of the wrench map",
        wrench,
        Signature::Position,
    );
    let place = {
        let kernel = kernel(model, &k.place, Scalar::Generic);
        let doc = counted("The place of the reaction", kernel.counts);
        let (statements, outputs) = (&kernel.statements, &kernel.outputs);
        let dim = parts::index(d.space.dim());
        quote! {
            #[doc = #doc]
            fn place(&self, x: &[Pose<T>]) -> [T; #dim] {
                #(#statements)*
                [#(#outputs),*]
            }
        }
    };
    let closed = derivatives(k).into_iter().filter(|_| !is_long);
    let derivatives = closed.map(|(name, what, s, block)| {
        method(name, what, kernel(model, &values(block), Scalar::F64), s)
    });
    let stored = stored.methods(model);
    let Traits {
        constraint,
        constraint_kernels,
        definition,
        element,
        reaction,
        visitor,
        ..
    } = Traits::of(d.space);
    let boxed = &constraint_kernels;
    let visit = (!t.drives.is_empty()).then(|| {
        quote! {
            fn visit_drives<V: #visitor>(visitor: &mut V) { #(#visits)* }
        }
    });
    quote! {
        #structure
        #drives

        // The methods of the trait have fixed signatures; not every definition uses every argument.
        #[allow(unused_variables)]
        impl #constraint for #name {
            #spec
            #from_arguments
            #visit
            fn element<T: Scalar>(&self) -> &dyn #element { self }
            fn reaction<T: Real>(&self) -> &dyn #reaction { self }
        }

        #[allow(unused_variables)]
        impl #definition for #name {
            #initialise
            #requirement
            #turned
            #points
            #axes
            #parallel_axes
            #data
        }

        #[allow(unused_variables)]
        impl<T: Scalar> #element for #name {
            fn spec(&self) -> &'static ConstraintSpec { &Self::SPEC }
            #phi
            #c_constant
            #c
            #b
            #gamma
            #component
        }

        #[allow(unused_variables)]
        impl<T: Real> #reaction for #name {
            #wrench
            #place
        }

        #[allow(unused_variables)]
        impl #constraint_kernels for #name {
            #stored
            #(#derivatives)*
            fn boxed(&self) -> Box<dyn #boxed> { Box::new(self.clone()) }
        }
    }
}

/// Returns the joint coordinate in printed form.
fn expanded(model: &mut Model, measure: Measure) -> Measure {
    match measure {
        Measure::Of(e) => Measure::Of(model.expand(e)),
        Measure::Kept(e) => Measure::Kept(e),
        Measure::Angle { sin, cos } => Measure::Angle {
            sin: model.expand(sin),
            cos: model.expand(cos),
        },
    }
}

/// Returns the row of the drive of an angle θ in space, `sin(θ − θ₀ − f)`. The row is computed from
/// the cosine and sine of the angle.
fn turned(model: &mut Model, [cos, sin]: [Expr; 2]) -> Expr {
    let [cos_f, sin_f] = model.inputs.motion_turn.map(|jet| jet[0]);
    let since = model.angle_since([cos, sin], model.inputs.turn_0);
    let g = &mut model.g;
    let (a, b) = (g.mul(since.sin, cos_f), g.mul(since.cos, sin_f));
    g.sub(a, b)
}

/// The traits that the generated types of a space implement. The defaults are the traits for the
/// plane.
struct Traits {
    constraint: TokenStream,
    definition: TokenStream,
    element: TokenStream,
    reaction: TokenStream,
    constraint_kernels: TokenStream,
    visitor: TokenStream,
    force: TokenStream,
    force_element: TokenStream,
}

impl Traits {
    fn of(space: Space) -> Self {
        match space {
            Space::Plane => Self {
                constraint: quote!(Constraint),
                definition: quote!(Definition),
                element: quote!(Element<T>),
                reaction: quote!(Reaction<T>),
                constraint_kernels: quote!(ConstraintKernels),
                visitor: quote!(Visitor),
                force: quote!(Force),
                force_element: quote!(ForceElement<T>),
            },
            Space::Space3 => Self {
                constraint: quote!(Constraint<Space3>),
                definition: quote!(Definition<Space3>),
                element: quote!(Element<T, Space3>),
                reaction: quote!(Reaction<T, Space3>),
                constraint_kernels: quote!(ConstraintKernels<Space3>),
                visitor: quote!(Visitor<Space3>),
                force: quote!(Force<Space3>),
                force_element: quote!(ForceElement<T, Space3>),
            },
        }
    }
}

/// Returns the module of a force.
pub(crate) fn force(
    d: &Definition,
    mut model: Model,
    runtime: &TokenStream,
    text: &str,
) -> syn::Result<TokenStream> {
    let Body::Force(terms) = std::mem::replace(&mut model.body, Body::Force(Vec::new())) else {
        unreachable!("elaborated as a force")
    };
    let k = derive::force(&mut model, &terms);
    let name = &d.name;
    let structure = parts::structure(d, &model, name, &d.doc, None);
    let spec = facts::force_spec(d, &model, &k, text);
    let from_arguments = parts::from_arguments(d, None);
    let initialise = parts::initialise(&model, None);
    let requirement = parts::requirement(&model);
    let points = parts::points(d);
    let q: Vec<Expr> = k.q.iter().map(|(_, e)| *e).collect();
    let of = |name, what, outputs: &[Expr]| {
        let kernel = kernel(&model, outputs, Scalar::Generic);
        method(name, what, kernel, Signature::Velocity)
    };
    let q = of("q", "Entries of Q", &q);
    let dq_dx = of("dq_dx", "∂Q/∂x", &values(&k.dq_dx));
    let dq_dv = of("dq_dv", "∂Q/∂v", &values(&k.dq_dv));
    let uses = parts::uses(runtime, d.space, false);
    let Traits {
        definition,
        force,
        force_element,
        ..
    } = Traits::of(d.space);
    Ok(quote! {
        #uses
        #structure

        impl #force for #name {
            #spec
            #from_arguments
            fn element<T: Real>(&self) -> &dyn #force_element { self }
        }

        #[allow(unused_variables)]
        impl #definition for #name {
            #initialise
            #requirement
            #points
        }

        #[allow(unused_variables)]
        impl<T: Real> #force_element for #name {
            fn spec(&self) -> &'static ForceSpec { &Self::SPEC }
            #q
            #dq_dx
            #dq_dv
        }
    })
}

/// Arguments of a method in addition to `x`, `f` and `out`.
#[derive(Clone, Copy)]
enum Signature {
    /// The method has no other arguments.
    Position,
    /// The method has the argument `v`.
    Velocity,
    /// The method has the argument `lambda`, in `f64`.
    Force,
    /// The method has the argument `v`, in `f64`.
    Rate,
    /// The method has the arguments `v` and `a`, in `f64`.
    Residual,
}

fn method(name: &str, what: &str, kernel: Kernel, s: Signature) -> TokenStream {
    use Signature::{Force, Position, Rate, Residual, Velocity};
    let name = format_ident!("{name}");
    let doc = counted(what, kernel.counts);
    let number = match s {
        Position | Velocity => quote!(T),
        Force | Rate | Residual => quote!(f64),
    };
    let v = matches!(s, Velocity | Rate | Residual).then(|| quote!(v: &[Twist<#number>],));
    let a = matches!(s, Residual).then(|| quote!(a: &[Twist<#number>],));
    let lambda = matches!(s, Force).then(|| quote!(lambda: &[#number],));
    let range = out_range(kernel.outputs.len());
    let body = kernel.into_out();
    quote! {
        #[doc = #doc]
        fn #name(&self, x: &[Pose<#number>], #v #a f: &[[#number; 3]], #lambda out: &mut [#number]) {
            #range
            #body
        }
    }
}

/// Returns the entries of C at their positions in the pattern.
fn indexed(
    name: &str,
    what: &str,
    entries: &[(usize, &derive::Entry)],
    kernel: impl Fn(&[Expr]) -> Kernel,
    arguments: Option<TokenStream>,
) -> TokenStream {
    let name = format_ident!("{name}");
    let outputs: Vec<Expr> = entries.iter().map(|(_, e)| e.value).collect();
    let kernel = kernel(&outputs);
    let doc = counted(what, kernel.counts);
    let assignments = entries.iter().zip(&kernel.outputs).map(|((k, _), e)| {
        let k = Literal::usize_unsuffixed(*k);
        quote!(out[#k] = #e;)
    });
    let statements = &kernel.statements;
    let range = out_range(entries.last().map_or(0, |(k, _)| k + 1));
    quote! {
        #[doc = #doc]
        fn #name(&self, #arguments out: &mut [T]) {
            #range
            #(#statements)*
            #(#assignments)*
        }
    }
}

/// Returns the statement that gives the number of entries of `out` once, so that the compiler needs
/// no bounds check for each entry. For a single entry there is no statement.
fn out_range(len: usize) -> Option<TokenStream> {
    let end = parts::index(len);
    (len > 1).then(|| quote!(let out = &mut out[..#end];))
}

fn values(block: &Sparse) -> Vec<Expr> {
    block.iter().map(|(_, e)| *e).collect()
}

fn counted(what: &str, counts: Counts) -> String {
    format!(" {what}. Operations: {counts}.")
}
