//! Parameters and initial values: their names, kinds and units.

use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Attribute, Expr, Ident, Token, bracketed};

use super::tree::{Binding, Kept, Param, ParamKind, name};
use crate::nearest::hint;

mod kw {
    syn::custom_keyword!(like);
    syn::custom_keyword!(optional);
}

/// Units that a parameter may have: the variants of `joints::spec::Unit` except `PerLength`.
pub const UNITS: [&str; 13] = [
    "Length",
    "Radius",
    "Angle",
    "Ratio",
    "Velocity",
    "AngularVelocity",
    "Force",
    "Torque",
    "Stiffness",
    "TorsionStiffness",
    "Damping",
    "TorsionDamping",
    "CorneringStiffness",
];

/// Kinds of parameters in addition to units.
const KINDS: [&str; 6] = [
    "Point",
    "Direction",
    "Axes",
    "GroundLine",
    "GroundPlane",
    "Function",
];

/// Kinds of initial values in addition to units.
const INITIAL_KINDS: [&str; 2] = ["Vector", "PerLength"];

impl Parse for Param {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let doc = doc_lines(&input.call(Attribute::parse_outer)?)?;
        let name = name(input)?;
        input.parse::<Token![:]>()?;
        let kind = input.parse()?;
        let default = match input.parse::<Option<Token![=]>>()? {
            Some(_) => Some(input.parse()?),
            None => None,
        };
        Ok(Self {
            name,
            doc,
            kind,
            default,
        })
    }
}

impl Parse for ParamKind {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        if input.peek(syn::token::Bracket) {
            return list(input);
        }
        let word: Ident = input.parse()?;
        match word.to_string().as_str() {
            "Point" => Ok(Self::Point(in_slot(input)?)),
            "Direction" => Ok(Self::Direction(in_slot(input)?)),
            "Axes" => {
                let slot = in_slot(input)?;
                let like = match input.parse::<Option<kw::like>>()? {
                    Some(_) => Some(name(input)?),
                    None => None,
                };
                let optional = input.parse::<Option<kw::optional>>()?.is_some();
                Ok(Self::Axes {
                    slot,
                    like,
                    optional,
                })
            }
            "GroundLine" => Ok(Self::GroundLine),
            "GroundPlane" => Ok(Self::GroundPlane),
            "Function" => {
                input.parse::<Token![<]>()?;
                let unit = unit(input.parse()?, &[])?;
                input.parse::<Token![>]>()?;
                Ok(Self::Function(unit))
            }
            _ => Ok(Self::Number(unit(word, &KINDS)?)),
        }
    }
}

/// Parses `[unit, …]` or `[Function<unit>, …]`.
fn list(input: ParseStream<'_>) -> syn::Result<ParamKind> {
    let list;
    let bracket = bracketed!(list in input);
    let kinds = Punctuated::<ParamKind, Token![,]>::parse_terminated(&list)?;
    let mut numbers = Vec::new();
    let mut functions = Vec::new();
    let mut others = 0;
    for kind in kinds {
        match kind {
            ParamKind::Number(unit) => numbers.push(unit),
            ParamKind::Function(unit) => functions.push(unit),
            _ => others += 1,
        }
    }
    match (numbers.len(), functions.len(), others) {
        (1.., 0, 0) => Ok(ParamKind::Numbers(numbers)),
        (0, 1.., 0) => Ok(ParamKind::Functions(functions)),
        _ => Err(syn::Error::new(
            bracket.span.join(),
            "a list holds units (`[Length, Length]`) or functions of units (`[Function<Force>, Function<Force>]`), \
             not both and nothing else",
        )),
    }
}

fn unit(word: Ident, beside: &[&str]) -> syn::Result<Ident> {
    if UNITS.iter().any(|u| word == u) {
        return Ok(word);
    }
    let known: Vec<&str> = beside.iter().chain(&UNITS).copied().collect();
    let what = if beside.is_empty() {
        "unit"
    } else {
        "kind or unit"
    };
    let text = word.to_string();
    Err(syn::Error::new_spanned(
        &word,
        format!("unknown {what} `{text}`{}", hint(&text, &known)),
    ))
}

fn in_slot(input: ParseStream<'_>) -> syn::Result<Ident> {
    input.parse::<Token![in]>()?;
    name(input)
}

/// One entry of `initial`.
pub(super) struct Initial(pub(super) Binding);

impl Parse for Initial {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let name = name(input)?;
        input.parse::<Token![:]>()?;
        let word: Ident = input.parse()?;
        let kept = match word.to_string().as_str() {
            "Vector" => Kept::Vector(in_slot(input)?),
            "PerLength" => Kept::Number(word),
            _ => Kept::Number(unit(word, &INITIAL_KINDS)?),
        };
        input.parse::<Token![=]>()?;
        Ok(Self(Binding {
            name,
            value: input.parse()?,
            kept: Some(kept),
        }))
    }
}

/// Returns the lines of a doc comment.
pub(super) fn doc_lines(attributes: &[Attribute]) -> syn::Result<Vec<String>> {
    attributes
        .iter()
        .map(|a| match &a.meta {
            syn::Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
                Expr::Lit(syn::ExprLit {
                    lit: syn::Lit::Str(line),
                    ..
                }) => Ok(line.value().trim().to_owned()),
                other => Err(syn::Error::new_spanned(other, "expected a doc comment")),
            },
            other => Err(syn::Error::new_spanned(
                other,
                "only doc comments may stand here",
            )),
        })
        .collect()
}
