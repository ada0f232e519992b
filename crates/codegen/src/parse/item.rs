//! The definition with its items. Each item has the form `word … ;`.

use syn::ext::IdentExt;
use syn::parse::ParseStream;
use syn::punctuated::Punctuated;
use syn::{Attribute, Ident, LitStr, Token, braced, bracketed, parenthesized};

use super::kind::{Initial, doc_lines};
use super::tree::{Binding, Definition, Kept, Kind, Param, name};
use super::variant::Forms;
use crate::nearest::hint;
use crate::space::Space;

mod kw {
    syn::custom_keyword!(apart);
    syn::custom_keyword!(gap);
    syn::custom_keyword!(kept);
    syn::custom_keyword!(on);
    syn::custom_keyword!(plane);
    syn::custom_keyword!(space);
}

/// First words of items.
const COMMON: [&str; 7] = [
    "params", "points", "let", "initial", "require", "scene", "variant",
];
const CONSTRAINT: [&str; 9] = [
    "bearings",
    "turns",
    "rows",
    "phi",
    "psi",
    "measure",
    "place",
    "component",
    "note",
];
const FORCE: [&str; 1] = ["force"];

/// Parses `plane Name(slot, …) { … }` or `space Name(slot, …) { … }`.
pub(super) fn definition(kind: Kind, input: ParseStream<'_>) -> syn::Result<Vec<Definition>> {
    let space = if input.parse::<Option<kw::plane>>()?.is_some() {
        Space::Plane
    } else if input.parse::<Option<kw::space>>()?.is_some() {
        Space::Space3
    } else {
        return Err(input.error(
            "expected `plane Name(i, j) { … }` or `space Name(i, j) { … }`: the space of the definition, its name, \
             its body slots",
        ));
    };
    let own_name = name(input)?;
    let slots;
    parenthesized!(slots in input);
    let slots = names(&slots)?;
    distinct(&slots, "body slot")?;
    if slots.is_empty() {
        return Err(syn::Error::new_spanned(
            &own_name,
            format!("`{own_name}` has no body slot: write `{own_name}(i)` or `{own_name}(i, j)`"),
        ));
    }
    let items;
    braced!(items in input);
    if !input.is_empty() {
        return Err(input.error("nothing may follow the definition"));
    }
    let mut d = Definition {
        space,
        doc: doc_lines(&items.call(Attribute::parse_outer)?)?,
        name: own_name,
        slots,
        params: Vec::new(),
        points_apart: false,
        bearings: false,
        bindings: Vec::new(),
        requirements: Vec::new(),
        rows: Vec::new(),
        has_gap: false,
        phi: None,
        psi: None,
        measures: Vec::new(),
        place: None,
        component: None,
        note: None,
        forces: Vec::new(),
        scene: None,
        variant: None,
    };
    let mut forms = None;
    while !items.is_empty() {
        item(kind, &items, &mut d, &mut forms)?;
    }
    check_presence(kind, &d)?;
    let params: Vec<Ident> = d.params.iter().map(|p| p.name.clone()).collect();
    distinct(&params, "parameter")?;
    Ok(match forms {
        Some(forms) => forms.of(&d),
        None => vec![d],
    })
}

fn check_presence(kind: Kind, d: &Definition) -> syn::Result<()> {
    let missing = |what: &str| {
        Err(syn::Error::new_spanned(
            &d.name,
            format!("`{}` has no {what}", d.name),
        ))
    };
    if d.doc.is_empty() {
        return missing("doc comment: say in `///` at the start of its body what it does");
    }
    match kind {
        Kind::Constraint if d.phi.is_none() && d.psi.is_none() => missing(
            "equation: write `phi: …;` on the level of positions or `psi: …;` on the level of velocities",
        ),
        Kind::Constraint if d.rows.is_empty() => {
            missing("names for its rows: write `rows: [x, y];`, one name for each")
        }
        Kind::Constraint if d.place.is_none() => missing(
            "place: write `place: point(i, s_i);`, the point at which its reaction is reported",
        ),
        Kind::Force if d.forces.is_empty() => missing("law: write `force: law on coordinate;`"),
        _ => Ok(()),
    }
}

fn item(
    kind: Kind,
    input: ParseStream<'_>,
    d: &mut Definition,
    forms: &mut Option<Forms>,
) -> syn::Result<()> {
    let word = input.call(Ident::parse_any)?;
    match (kind, word.to_string().as_str()) {
        (_, "params") => {
            let list;
            braced!(list in input);
            d.params
                .extend(Punctuated::<Param, Token![,]>::parse_terminated(&list)?);
            return Ok(());
        }
        (_, "initial") => {
            let list;
            braced!(list in input);
            let list = Punctuated::<Initial, Token![,]>::parse_terminated(&list)?;
            d.bindings.extend(list.into_iter().map(|i| i.0));
            return Ok(());
        }
        (_, "let") => {
            let name = name(input)?;
            input.parse::<Token![=]>()?;
            d.bindings.push(Binding {
                name,
                value: input.parse()?,
                kept: None,
            });
        }
        (_, "require") => {
            let words = input.parse()?;
            input.parse::<Token![:]>()?;
            d.requirements.push((words, input.parse()?));
        }
        (_, "points") => {
            input.parse::<kw::apart>()?;
            once(&word, d.points_apart.then_some(()))?;
            d.points_apart = true;
        }
        (_, "scene") => once(&word, d.scene.replace(input.parse()?))?,
        (_, "variant") => {
            let found = Forms::parse(input, d.bindings.len())?;
            return once(&word, forms.replace(found));
        }
        (Kind::Force, "force") => {
            input.parse::<Token![:]>()?;
            let law = input.parse()?;
            input.parse::<kw::on>()?;
            d.forces.push((law, input.parse()?));
        }
        (Kind::Constraint, known) if CONSTRAINT.contains(&known) => {
            constraint_item(&word, input, d)?;
        }
        (_, other) => return Err(unknown_item(kind, &word, other)),
    }
    input.parse::<Token![;]>()?;
    Ok(())
}

fn constraint_item(word: &Ident, input: ParseStream<'_>, d: &mut Definition) -> syn::Result<()> {
    match word.to_string().as_str() {
        "bearings" => {
            once(word, d.bearings.then_some(()))?;
            if !super::bearings::are_possible(d) {
                return Err(syn::Error::new_spanned(word, super::bearings::NEEDED));
            }
            d.bearings = true;
        }
        "turns" => {
            let name = name(input)?;
            input.parse::<Token![:]>()?;
            d.bindings.push(Binding {
                name,
                value: input.parse()?,
                kept: Some(Kept::Turn),
            });
        }
        "rows" => {
            input.parse::<Token![:]>()?;
            let list;
            bracketed!(list in input);
            once(word, (!d.rows.is_empty()).then_some(()))?;
            if list.peek(kw::gap) && list.peek2(Ident) {
                list.parse::<kw::gap>()?;
                d.has_gap = true;
            }
            d.rows = names(&list)?;
            distinct(&d.rows, "row")?;
        }
        "phi" => {
            input.parse::<Token![:]>()?;
            once(word, d.phi.replace(input.parse()?))?;
            if d.psi.is_some() {
                return Err(syn::Error::new_spanned(
                    word,
                    "`phi` stands before `psi`: the names in `rows` are those of `phi`, then those of `psi`",
                ));
            }
        }
        "psi" => {
            input.parse::<Token![:]>()?;
            once(word, d.psi.replace(input.parse()?))?;
        }
        "measure" => {
            let name = name(input)?;
            let value = if input.parse::<Option<Token![,]>>()?.is_some() {
                input.parse::<kw::kept>()?;
                None
            } else {
                input.parse::<Token![:]>()?;
                Some(input.parse()?)
            };
            d.measures.push((name, value));
        }
        "place" => {
            input.parse::<Token![:]>()?;
            once(word, d.place.replace(input.parse()?))?;
        }
        "note" => {
            let words: LitStr = input.parse()?;
            if words.value().trim().is_empty() {
                return Err(syn::Error::new_spanned(
                    &words,
                    "`note` has no words: say what a reader of the reaction must know, or leave it out",
                ));
            }
            once(word, d.note.replace(words))?;
        }
        _ => {
            let name = name(input)?;
            input.parse::<Token![:]>()?;
            once(word, d.component.replace((name, input.parse()?)))?;
        }
    }
    Ok(())
}

fn unknown_item(kind: Kind, word: &Ident, text: &str) -> syn::Error {
    let (own, what, other_words, other) = match kind {
        Kind::Constraint => (&CONSTRAINT[..], "joint!", &FORCE[..], "force!"),
        Kind::Force => (&FORCE[..], "force!", &CONSTRAINT[..], "joint!"),
    };
    let message = if other_words.contains(&text) {
        format!("`{text}` belongs into a `{other}`, this is a `{what}`")
    } else {
        let known: Vec<&str> = COMMON.iter().chain(own).copied().collect();
        format!("unknown item `{text}`{}", hint(text, &known))
    };
    syn::Error::new_spanned(word, message)
}

/// Parses `name, …`.
fn names(input: ParseStream<'_>) -> syn::Result<Vec<Ident>> {
    let list = Punctuated::<Ident, Token![,]>::parse_terminated_with(input, name)?;
    Ok(list.into_iter().collect())
}

fn distinct(names: &[Ident], what: &str) -> syn::Result<()> {
    for (k, name) in names.iter().enumerate() {
        if names[..k].contains(name) {
            return Err(syn::Error::new_spanned(
                name,
                format!("two {what}s are called `{name}`"),
            ));
        }
    }
    Ok(())
}

fn once<T>(at: &Ident, previous: Option<T>) -> syn::Result<()> {
    match previous {
        Some(_) => Err(syn::Error::new_spanned(
            at,
            format!("`{at}` is given twice"),
        )),
        None => Ok(()),
    }
}
