//! The inputs of a module: the arguments of its functions, and their indices in the mechanism of a
//! run. The code for principal axes of bodies in space, which may depend on inputs, is also
//! generated here.

use joints::RecordedNumber;
use model::{BodyRecord, Principal, SpaceKind};
use proc_macro2::TokenStream;
use quote::quote;

use crate::functions::Functions;
use crate::parameters::Inputs;
use crate::subject::Subject;

/// Generates the constants for the inputs that functions have as arguments.
pub(super) fn parameters(inputs: &Inputs) -> TokenStream {
    let n = inputs.list.len();
    if n == 0 {
        return TokenStream::new();
    }
    let of = inputs.list.iter().map(|p| {
        let (name, described) = (&p.name, p.described);
        quote!((#name, #described))
    });
    let described = inputs.list.iter().map(|p| p.described);
    quote! {
        /// Number of numbers of the scene that functions take as `p`.
        pub const N_P: usize = #n;
        /// What each of them is, with the keys of the scene that change it, and its value in the
        /// scene.
        pub const PARAMETERS: [(&str, f64); N_P] = [#(#of),*];
        /// Values of the inputs in the scene.
        pub const DESCRIBED: [f64; N_P] = [#(#described),*];
    }
}

/// Generates the rotation from the axes of the angular velocities to the frames of bodies in space.
pub(super) fn principal_axes(subject: &Subject<'_>, functions: &Functions) -> TokenStream {
    let mechanism = &subject.prepared.mechanism;
    let (bodies, space) = (mechanism.bodies(), mechanism.space());
    if space != SpaceKind::Space3 {
        return TokenStream::new();
    }
    let recorded = &functions.equations.recording.beside.principal;
    let number = |r: &RecordedNumber| subject.inputs.at(r.place());
    let varies = recorded
        .iter()
        .flatten()
        .flatten()
        .any(|r| number(r).is_some());
    if varies {
        let n = bodies.len();
        let axes = bodies.iter().zip(recorded).map(|(body, recorded)| {
            let known = body.principal.as_ref().map(Principal::quaternion);
            let known = known.unwrap_or([1.0, 0.0, 0.0, 0.0]);
            let e = [0, 1, 2, 3].map(|i| {
                let input = recorded.as_ref().and_then(|e| number(&e[i]));
                let x = known[i];
                input.map_or_else(|| quote!(#x), |k| quote!(p[#k]))
            });
            quote!([#(#e),*])
        });
        return quote! {
            /// The rotation of each body from its principal axes to those of its frame, as a
            /// quaternion (w, x, y, z).
            pub fn principal_axes(p: &[f64; N_P]) -> [[f64; 4]; #n] { [#(#axes),*] }
        };
    }
    let n = bodies.len();
    let of = |body: &BodyRecord| match &body.principal {
        Some(principal) => principal.quaternion(),
        None => [1.0, 0.0, 0.0, 0.0],
    };
    let axes = bodies.iter().map(|body| {
        let e = of(body);
        quote!([#(#e),*])
    });
    quote! {
        /// The rotation of each body from its principal axes to those of its frame, as a
        /// quaternion (w, x, y, z).
        pub const PRINCIPAL_AXES: [[f64; 4]; #n] = [#(#axes),*];
    }
}

/// Generates the indices of the inputs in the mechanism of a run.
pub(super) fn inputs_of_code(inputs: &Inputs, path: &syn::Path) -> TokenStream {
    let shape = inputs.shape;
    let list = inputs.list.iter().enumerate().map(|(k, p)| {
        let places = &p.places;
        quote! {
            #path::code::CodeInput {
                name: ::std::borrow::Cow::Borrowed(PARAMETERS[#k].0),
                described: DESCRIBED[#k],
                places: ::std::borrow::Cow::Borrowed(&[#(#places),*]),
            }
        }
    });
    quote! {
        static INPUTS: #path::code::CodeInputs = #path::code::CodeInputs {
            shape: #shape,
            list: ::std::borrow::Cow::Borrowed(&[#(#list),*]),
        };
    }
}
