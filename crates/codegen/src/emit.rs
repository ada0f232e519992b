//! The text of a generated module: type, facts, kernels.

mod constructors;
mod data;
mod facts;
mod parts;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use symbolic::{Counts, Expr, Scalar};

use crate::data::{derivations, of_measure, of_turn, stored};
use crate::derive::{self, Component, ConstraintKernels, Sparse};
use crate::elaborate::{Body, ConstraintBody, Counted, Measure, Model};
use crate::kernel::kernel;
use crate::parse::Definition;
use crate::space::Space;
use parts::{Driven, Type};

/// The module of a constraint: its type and one type for the drive of each measure.
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
    let kernels = derive::constraint(&mut model, &body, &component, &by_data)
        .map_err(|row| idle(&body.at, row))?;
    let drive = |(name, measure): &(Ident, Measure)| parts::Drive {
        measure: name.clone(),
        name: format_ident!("{}{}Drive", d.name, parts::camel(name)),
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
    let mut items = vec![constraint_type(d, &model, &main, &kernels, &body, text)];
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
        let kernels = derive::constraint(&mut model, &driven, &component, &by_data)
            .map_err(|row| idle(&driven.at, row))?;
        let mut data = data.clone();
        let (rows, doc) = match drive.by {
            Driven::Measure => {
                data.push(of_measure(&model, kernels.unit_of_measure(d.space)));
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
        items.push(constraint_type(d, &model, &drive, &kernels, &driven, text));
    }
    let uses = parts::uses(runtime, d.space, true);
    Ok(quote!(#uses #(#items)*))
}

fn constraint_type(
    d: &Definition,
    model: &Model,
    t: &Type,
    k: &ConstraintKernels,
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
    let visit = t
        .drives
        .iter()
        .map(|parts::Drive { name, .. }| quote!(visitor.drive::<#name>();));

    let kernel_of = |name, what, outputs: &[Expr], s| method(name, what, model, outputs, s);
    let sparse = |name, what, block: &Sparse, s| method(name, what, model, &values(block), s);
    let phi = kernel_of("phi", "Φ", &k.phi, Signature::Position);
    let (constants, varying): (Vec<_>, Vec<_>) =
        k.c.iter().enumerate().partition(|(_, e)| e.constant);
    let what = "Constant entries of C";
    let c_constant = indexed("c_constant", what, model, &constants, Scalar::F64);
    let c = indexed(
        "c",
        "Varying entries of C",
        model,
        &varying,
        Scalar::Generic,
    );
    let b = kernel_of("b", "b", &k.b, Signature::Position);
    let gamma = kernel_of("gamma", "Γ", &k.gamma, Signature::Velocity);
    let what = "Entries of the wrench map";
    let wrench = sparse("wrench", what, &k.wrench, Signature::Wrench);
    let what = "Coefficients of the named component";
    let component = kernel_of("component", what, &k.component, Signature::Position);
    let place = {
        let kernel = kernel(model, &k.place, Scalar::Generic);
        let doc = counted("The place of the reaction", kernel.counts);
        let (statements, outputs) = (&kernel.statements, &kernel.outputs);
        let dim = parts::index(d.space.dim());
        quote! {
            #[doc = #doc]
            fn place(&self, x: &[Pose<T>]) -> [T; #dim] where T: Real {
                #(#statements)*
                [#(#outputs),*]
            }
        }
    };
    let d_force_dx = sparse("d_force_dx", "∂(Cᵀλ)/∂x", &k.d_force_dx, Signature::Force);
    let what = "∂(C·a − Γ)/∂x";
    let d_residual_dx = sparse("d_residual_dx", what, &k.d_residual_dx, Signature::Residual);
    let d_gamma_dv = sparse("d_gamma_dv", "∂Γ/∂v", &k.d_gamma_dv, Signature::Velocity);
    let what = "∂(C·v − b)/∂x";
    let d_velocity_dx = sparse("d_velocity_dx", what, &k.d_velocity_dx, Signature::Velocity);
    let d_phi_dp = kernel_of("d_phi_dp", "∂(λᵀΦ)/∂p", &k.d_phi_dp, Signature::Force);
    let what = "∂(λᵀ(C·a − Γ))/∂p";
    let d_residual_dp = kernel_of("d_residual_dp", what, &k.d_residual_dp, Signature::Work);
    let Traits {
        constraint,
        definition,
        derivatives,
        element,
        positions,
        visitor,
        ..
    } = Traits::of(d.space);
    quote! {
        #structure
        #drives

        // The methods of the trait have fixed signatures; not every definition uses every argument.
        #[allow(unused_variables)]
        impl #constraint for #name {
            #spec
            #from_arguments
            fn visit_drives<V: #visitor>(visitor: &mut V) { #(#visit)* }
            fn positions<T: Ring>(&self) -> &dyn #positions { self }
            fn element<T: Ring>(&self) -> &dyn #element { self }
            fn derivatives<T: Ring>(&self) -> &dyn #derivatives { self }
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
        #[allow(clippy::too_many_arguments)]
        impl<T: Ring> #positions for #name {
            fn spec(&self) -> &'static ConstraintSpec { &Self::SPEC }
            #phi
            #c_constant
            #c
        }

        #[allow(unused_variables)]
        #[allow(clippy::too_many_arguments)]
        impl<T: Ring> #element for #name {
            #b
            #gamma
            #wrench
            #component
            #place
            #d_phi_dp
        }

        #[allow(unused_variables)]
        #[allow(clippy::too_many_arguments)]
        impl<T: Ring> #derivatives for #name {
            #d_force_dx
            #d_residual_dx
            #d_gamma_dv
            #d_velocity_dx
            #d_residual_dp
        }
    }
}

/// The measure as it is printed.
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

/// The row of the drive of an angle θ in space, `sin(θ − θ₀ − f)`, from cosine and sine of the
/// angle.
fn turned(model: &mut Model, [cos, sin]: [Expr; 2]) -> Expr {
    let [cos_f, sin_f] = model.inputs.motion_turn.map(|jet| jet[0]);
    let since = model.angle_since([cos, sin], model.inputs.turn_0);
    let g = &mut model.g;
    let (a, b) = (g.mul(since.sin, cos_f), g.mul(since.cos, sin_f));
    g.sub(a, b)
}

/// The traits that the generated types of a space implement; those of the plane are their defaults.
struct Traits {
    constraint: TokenStream,
    definition: TokenStream,
    positions: TokenStream,
    element: TokenStream,
    derivatives: TokenStream,
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
                positions: quote!(Positions<T>),
                element: quote!(Element<T>),
                derivatives: quote!(Derivatives<T>),
                visitor: quote!(Visitor),
                force: quote!(Force),
                force_element: quote!(ForceElement<T>),
            },
            Space::Space3 => Self {
                constraint: quote!(Constraint<Space3>),
                definition: quote!(Definition<Space3>),
                positions: quote!(Positions<T, Space3>),
                element: quote!(Element<T, Space3>),
                derivatives: quote!(Derivatives<T, Space3>),
                visitor: quote!(Visitor<Space3>),
                force: quote!(Force<Space3>),
                force_element: quote!(ForceElement<T, Space3>),
            },
        }
    }
}

/// The module of a force.
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
    let q = method("q", "Entries of Q", &model, &q, Signature::Velocity);
    let dq_dx = method(
        "dq_dx",
        "∂Q/∂x",
        &model,
        &values(&k.dq_dx),
        Signature::Velocity,
    );
    let dq_dv = method(
        "dq_dv",
        "∂Q/∂v",
        &model,
        &values(&k.dq_dv),
        Signature::Velocity,
    );
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
    /// No other arguments.
    Position,
    /// No other arguments, numbers with quotients.
    Wrench,
    /// `v`
    Velocity,
    /// `lambda`
    Force,
    /// `v` and `a`
    Residual,
    /// `v`, `a` and `lambda`
    Work,
}

fn method(name: &str, what: &str, model: &Model, outputs: &[Expr], s: Signature) -> TokenStream {
    let name = format_ident!("{name}");
    let kernel = kernel(model, outputs, Scalar::Generic);
    let doc = counted(what, kernel.counts);
    use Signature::{Force, Residual, Velocity, Work};
    let v = matches!(s, Velocity | Residual | Work).then(|| quote!(v: &[Twist<T>],));
    let a = matches!(s, Residual | Work).then(|| quote!(a: &[Twist<T>],));
    let lambda = matches!(s, Force | Work).then(|| quote!(lambda: &[T],));
    let range = out_range(outputs.len());
    let body = kernel.into_out();
    let bound = matches!(s, Signature::Wrench).then(|| quote!(where T: Real));
    quote! {
        #[doc = #doc]
        fn #name(&self, x: &[Pose<T>], #v #a f: &[[T; 3]], #lambda out: &mut [T]) #bound {
            #range
            #body
        }
    }
}

/// Entries of C at their positions in the pattern.
fn indexed(
    name: &str,
    what: &str,
    model: &Model,
    entries: &[(usize, &derive::Entry)],
    scalar: Scalar,
) -> TokenStream {
    let name = format_ident!("{name}");
    let outputs: Vec<Expr> = entries.iter().map(|(_, e)| e.value).collect();
    let kernel = kernel(model, &outputs, scalar);
    let doc = counted(what, kernel.counts);
    let assignments = entries.iter().zip(&kernel.outputs).map(|((k, _), e)| {
        let k = Literal::usize_unsuffixed(*k);
        quote!(out[#k] = #e;)
    });
    let statements = &kernel.statements;
    let range = out_range(entries.last().map_or(0, |(k, _)| k + 1));
    let signature = match scalar {
        Scalar::F64 => quote!(fn #name(&self, out: &mut [f64])),
        Scalar::Generic => {
            quote!(fn #name(&self, x: &[Pose<T>], f: &[[T; 3]], out: &mut [T]))
        }
    };
    quote! {
        #[doc = #doc]
        #signature {
            #range
            #(#statements)*
            #(#assignments)*
        }
    }
}

/// The statement that states once how many entries of `out` are written, so that this is not asked
/// again for each entry; nothing for a single one.
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
