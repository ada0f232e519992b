//! The specification of a definition as a constant.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::{data, parts};
use crate::derive::{ConstraintKernels, ForceKernels, Sparse};
use crate::elaborate::{ConstraintBody, Model, Source};
use crate::parse::{Definition, Param, ParamKind};
use parts::{Driven, Type, index};

pub(super) fn constraint_spec(
    d: &Definition,
    t: &Type,
    k: &ConstraintKernels,
    body: &ConstraintBody,
    text: &str,
) -> TokenStream {
    let n_dof = d.space.n_dof();
    let motion = t.driven.map(|by| match by {
        Driven::Turn => format_ident!("Angle"),
        Driven::Measure | Driven::Rows => k.unit_of_measure(d.space),
    });
    let common = common(d, &t.name.to_string(), &t.scene_type, &t.doc, motion, text);
    let role = if t.driven.is_some() {
        quote!(Role::Drive)
    } else {
        quote!(Role::Joint)
    };
    let holonomic = index(body.holonomic);
    let named = t.rows.iter().zip(&k.restricts_start);
    let rows = named.enumerate().map(|(i, (name, restricts))| {
        let row = if *restricts {
            quote!(Row::restricting_start(#name))
        } else {
            quote!(Row::keeping_start(#name))
        };
        if d.has_gap && i == 0 && t.driven.is_none() {
            quote!(#row.gap())
        } else {
            row
        }
    });
    let c = k.c.iter().map(|e| {
        let [row, slot, dof] = [e.row, e.column / n_dof, e.column % n_dof].map(index);
        if e.constant {
            quote!(Entry::constant(#row, #slot, #dof))
        } else {
            quote!(Entry::varying(#row, #slot, #dof))
        }
    });
    let rheonomic = !k.b.is_empty();
    let component = match &t.component {
        Some(name) => quote!(Some(#name)),
        None => quote!(None),
    };
    let note = match d.note.as_ref().map(syn::LitStr::value) {
        Some(words) if t.driven.is_none() => quote!(Some(#words)),
        _ => quote!(None),
    };
    let measures = t.drives.iter().map(|drive| {
        let (name, by) = (drive.measure.to_string(), drive.by);
        let drive = drive.name.to_string();
        match by {
            Driven::Measure | Driven::Turn => quote!(Measure::new(#name, #drive)),
            Driven::Rows => quote!(Measure::kept(#name, #drive)),
        }
    });
    let turning = t.driven == Some(Driven::Turn);
    let turns = index(t.turns);
    let wrench = pattern(&k.wrench);
    let d_force_dx = pattern(&k.d_force_dx);
    let (shared, [d_residual_dx, d_gamma_dv, d_velocity_dx]) = of_rows(k);
    let data = data::facts(d, &t.data);
    quote! {
        const SPEC: ConstraintSpec = {
            #shared
            ConstraintSpec {
            common: #common,
            role: #role,
            rows: &[#(#rows),*],
            holonomic: #holonomic,
            c: &[#(#c),*],
            rheonomic: #rheonomic,
            wrench: #wrench,
            component: #component,
            note: #note,
            measures: &[#(#measures),*],
            turning: #turning,
            turns: #turns,
            d_force_dx: #d_force_dx,
            d_residual_dx: #d_residual_dx,
            d_gamma_dv: #d_gamma_dv,
            d_velocity_dx: #d_velocity_dx,
            data: #data,
        } };
    }
}

/// Returns the patterns of the derivatives of rows. For most definitions, all three derivatives
/// have the same pattern; this pattern is printed once.
fn of_rows(k: &ConstraintKernels) -> (Option<TokenStream>, [TokenStream; 3]) {
    let blocks = [&k.d_residual_dx, &k.d_gamma_dv, &k.d_velocity_dx];
    let same = |a: &Sparse, b: &Sparse| a.iter().map(|e| e.0).eq(b.iter().map(|e| e.0));
    let first = &k.d_residual_dx;
    let is_shared = !first.is_empty() && blocks[1..].iter().any(|block| same(block, first));
    let patterns = blocks.map(|block| {
        if is_shared && same(block, first) {
            quote!(ROWS_BY_X)
        } else {
            pattern(block)
        }
    });
    let entries = pattern(first);
    let shared = quote! {
        const ROWS_BY_X: &[[usize; 2]] = #entries;
    };
    (is_shared.then_some(shared), patterns)
}

pub(super) fn force_spec(
    d: &Definition,
    model: &Model,
    k: &ForceKernels,
    text: &str,
) -> TokenStream {
    let common = common(
        d,
        &d.name.to_string(),
        &parts::scene_type(d),
        &d.doc,
        None,
        text,
    );
    let q = k.q.iter().map(|(column, _)| index(*column));
    let dq_dx = pattern(&k.dq_dx);
    let dq_dv = pattern(&k.dq_dv);
    let dissipative = !k.dq_dv.is_empty();
    let of_time = |s: &Source| matches!(s, Source::Function { .. });
    let rheonomic = k.q.iter().any(|(_, e)| model.depends_on(*e, of_time));
    quote! {
        const SPEC: ForceSpec = ForceSpec {
            common: #common,
            q: &[#(#q),*],
            dq_dx: #dq_dx,
            dq_dv: #dq_dv,
            dissipative: #dissipative,
            turns: 0,
            rheonomic: #rheonomic,
        };
    }
}

fn common(
    d: &Definition,
    name: &str,
    scene_type: &str,
    doc: &[String],
    motion: Option<Ident>,
    text: &str,
) -> TokenStream {
    let driven = motion.is_some();
    let variant = match &d.variant {
        Some(variant) if !driven => {
            let (key, value, default) = (variant.key.to_string(), &variant.value, variant.default);
            quote!(Some(Variant { key: #key, value: #value, default: #default }))
        }
        _ => quote!(None),
    };
    let doc = doc.join(" ");
    let slots = d.slots.iter().map(ToString::to_string);
    let mut parameters: Vec<TokenStream> = d.params.iter().map(|p| parameter(d, p)).collect();
    if let Some(unit) = motion {
        parameters.push(quote! {
            Parameter::required(
                "motion",
                Shape::Functions(&[Unit::#unit]),
                "The function of time that the measure follows.",
            )
        });
    }
    let (points_apart, bearings) = (d.points_apart, d.bearings && !driven);
    let requirements = d.requirements.iter().map(|(words, _)| words.value());
    // The text of a drive is the text of its joint, whose specification already contains it.
    let text = if driven { "" } else { text };
    quote! {
        Spec {
            name: #name,
            scene_type: #scene_type,
            variant: #variant,
            doc: #doc,
            text: #text,
            slots: &[#(#slots),*],
            parameters: &[#(#parameters),*],
            points_apart: #points_apart,
            bearings: #bearings,
            requirements: &[#(#requirements),*],
        }
    }
}

fn parameter(d: &Definition, p: &Param) -> TokenStream {
    let name = p.name.to_string();
    let shape = match &p.kind {
        ParamKind::Point(s) => {
            let slot = parts::slot(d, s);
            quote!(Shape::Point { slot: #slot })
        }
        ParamKind::Direction(s) => {
            let slot = parts::slot(d, s);
            quote!(Shape::Direction { slot: #slot })
        }
        ParamKind::Axes { slot, like, .. } => {
            let slot = parts::slot(d, slot);
            let like = match like {
                Some(like) => {
                    let k = d.params.iter().position(|p| p.name == *like);
                    let k = index(k.expect("checked while elaborating"));
                    quote!(Some(#k))
                }
                None => quote!(None),
            };
            quote!(Shape::Axes { slot: #slot, like: #like })
        }
        ParamKind::GroundLine => quote!(Shape::GroundLine),
        ParamKind::GroundPlane => quote!(Shape::GroundPlane),
        ParamKind::Number(unit) => quote!(Shape::Numbers(&[Unit::#unit])),
        ParamKind::Numbers(units) => quote!(Shape::Numbers(&[#(Unit::#units),*])),
        ParamKind::Function(unit) => quote!(Shape::Functions(&[Unit::#unit])),
        ParamKind::Functions(units) => quote!(Shape::Functions(&[#(Unit::#units),*])),
    };
    let doc = p.doc.join(" ");
    let optional = matches!(
        p.kind,
        ParamKind::Axes { optional: true, .. } | ParamKind::GroundPlane
    );
    if optional || p.default.is_some() {
        quote!(Parameter::optional(#name, #shape, #doc))
    } else {
        quote!(Parameter::required(#name, #shape, #doc))
    }
}

fn pattern(block: &Sparse) -> TokenStream {
    let entries = block.iter().map(|([row, column], _)| {
        let (row, column) = (index(*row), index(*column));
        quote!([#row, #column])
    });
    quote!(&[#(#entries),*])
}
