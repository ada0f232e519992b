//! The definition language: what may be written, as a tree. Meaning comes later, in `elaborate`.
//!
//! ```text
//! plane Name(slot, …) {
//!     /// What it does.
//!     params { name: Kind, … }         Point in slot · Direction in slot · GroundLine · a unit ·
//!                                      [unit, …] · Function<unit> · [Function<unit>, …]; `= expr` makes a
//!                                      number optional
//!     points apart;                    the place in a scene is one point for each Point, not a common one
//!     let name = expr;
//!     initial { name: Kind = expr, … } kept from the assembled start
//!     require "words": condition;      must hold at the assembled start
//!     rows: [name, …];
//!     phi: expr;                       or   psi: expr;   (constraints)
//!     measure name: expr;              what a drive may prescribe
//!     place: expr;                     where the reaction is reported
//!     component name: expr;            a named direction of the reaction
//!     force: law on coordinate;        (forces) Q = Σ law · ∂coordinate/∂x
//!     scene "type";                    another scene type than the name
//!     variant key = "value", default;  one of several definitions of a scene type
//! }
//! ```

use proc_macro2::TokenStream;
use syn::parse::{Parse, ParseStream, Parser};
use syn::punctuated::Punctuated;
use syn::{Attribute, Expr, Ident, LitStr, Token, braced, bracketed, parenthesized};

mod kw {
    syn::custom_keyword!(apart);
    syn::custom_keyword!(component);
    syn::custom_keyword!(default);
    syn::custom_keyword!(force);
    syn::custom_keyword!(initial);
    syn::custom_keyword!(measure);
    syn::custom_keyword!(on);
    syn::custom_keyword!(params);
    syn::custom_keyword!(phi);
    syn::custom_keyword!(place);
    syn::custom_keyword!(plane);
    syn::custom_keyword!(points);
    syn::custom_keyword!(psi);
    syn::custom_keyword!(require);
    syn::custom_keyword!(rows);
    syn::custom_keyword!(scene);
    syn::custom_keyword!(variant);
}

/// What a definition defines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `joint!`
    Constraint,
    /// `force!`
    Force,
}

/// One definition, as written.
pub struct Definition {
    /// Its name.
    pub name: Ident,
    /// Names of its body slots.
    pub slots: Vec<Ident>,
    /// Its doc comment, one string for each line.
    pub doc: Vec<String>,
    /// Its parameters.
    pub params: Vec<Param>,
    /// Whether its place in a scene is one point for each point parameter.
    pub points_apart: bool,
    /// `let` and `initial`, in the order written.
    pub bindings: Vec<Binding>,
    /// Conditions on the assembled start.
    pub requirements: Vec<(LitStr, Expr)>,
    /// Names of the rows.
    pub rows: Vec<Ident>,
    /// Position level constraint.
    pub phi: Option<Expr>,
    /// Velocity level constraint.
    pub psi: Option<Expr>,
    /// What drives may prescribe.
    pub measures: Vec<(Ident, Expr)>,
    /// Where the reaction is reported.
    pub place: Option<Expr>,
    /// A named direction of the reaction.
    pub component: Option<(Ident, Expr)>,
    /// Laws and their coordinates.
    pub forces: Vec<(Expr, Expr)>,
    /// Scene type, if it is not the name.
    pub scene: Option<LitStr>,
    /// Key, value and whether it is the default.
    pub variant: Option<(Ident, LitStr, bool)>,
}

/// One parameter.
pub struct Param {
    /// Its name.
    pub name: Ident,
    /// Its doc comment.
    pub doc: Vec<String>,
    /// What it takes.
    pub kind: ParamKind,
    /// Value at the assembled start where none is given.
    pub default: Option<Expr>,
}

/// What a parameter takes.
pub enum ParamKind {
    /// A point of the body in a slot.
    Point(Ident),
    /// A direction in the frame of the body in a slot.
    Direction(Ident),
    /// A line of the ground.
    GroundLine,
    /// One number with its unit.
    Number(Ident),
    /// Several numbers.
    Numbers(Vec<Ident>),
    /// One function of time.
    Function(Ident),
    /// Several functions of time.
    Functions(Vec<Ident>),
}

/// `let` or one entry of `initial`.
pub struct Binding {
    /// Its name.
    pub name: Ident,
    /// Its value.
    pub value: Expr,
    /// What is kept, for `initial`; nothing for `let`.
    pub kept: Option<Kept>,
}

/// What an `initial` value is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// One number.
    Number,
    /// Two components in a frame.
    Vector,
}

/// Parses the body of a `joint!` or `force!`.
///
/// # Errors
/// At the token that does not fit.
pub fn definition(kind: Kind, body: TokenStream) -> syn::Result<Definition> {
    (|input: ParseStream<'_>| parse_definition(kind, input)).parse2(body)
}

fn parse_definition(kind: Kind, input: ParseStream<'_>) -> syn::Result<Definition> {
    if !input.peek(kw::plane) {
        return Err(input.error("expected `plane`: the space of the definition"));
    }
    input.parse::<kw::plane>()?;
    let name: Ident = input.parse()?;
    let slots;
    parenthesized!(slots in input);
    let slots: Vec<Ident> = Punctuated::<Ident, Token![,]>::parse_terminated(&slots)?
        .into_iter()
        .collect();
    if slots.is_empty() {
        return Err(syn::Error::new_spanned(
            &name,
            "a definition has at least one body slot",
        ));
    }
    let items;
    braced!(items in input);
    if !input.is_empty() {
        return Err(input.error("nothing may follow the definition"));
    }
    let mut d = Definition {
        doc: doc_lines(&items.call(Attribute::parse_outer)?)?,
        name,
        slots,
        params: Vec::new(),
        points_apart: false,
        bindings: Vec::new(),
        requirements: Vec::new(),
        rows: Vec::new(),
        phi: None,
        psi: None,
        measures: Vec::new(),
        place: None,
        component: None,
        forces: Vec::new(),
        scene: None,
        variant: None,
    };
    while !items.is_empty() {
        parse_item(kind, &items, &mut d)?;
    }
    check_presence(kind, &d)?;
    Ok(d)
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
        Kind::Constraint if d.phi.is_none() && d.psi.is_none() => missing("`phi:` and no `psi:`"),
        Kind::Constraint if d.rows.is_empty() => missing("`rows: […];`"),
        Kind::Constraint if d.place.is_none() => missing("`place:`"),
        Kind::Force if d.forces.is_empty() => missing("`force: … on …;`"),
        _ => Ok(()),
    }
}

fn parse_item(kind: Kind, input: ParseStream<'_>, d: &mut Definition) -> syn::Result<()> {
    let look = input.lookahead1();
    if look.peek(kw::params) {
        input.parse::<kw::params>()?;
        let list;
        braced!(list in input);
        d.params
            .extend(Punctuated::<Param, Token![,]>::parse_terminated(&list)?);
        return Ok(());
    }
    if look.peek(kw::initial) {
        input.parse::<kw::initial>()?;
        let list;
        braced!(list in input);
        let list = Punctuated::<Initial, Token![,]>::parse_terminated(&list)?;
        d.bindings.extend(list.into_iter().map(|i| i.0));
        return Ok(());
    }
    if look.peek(Token![let]) {
        input.parse::<Token![let]>()?;
        let name = input.parse()?;
        input.parse::<Token![=]>()?;
        d.bindings.push(Binding {
            name,
            value: input.parse()?,
            kept: None,
        });
    } else if look.peek(kw::require) {
        input.parse::<kw::require>()?;
        let words = input.parse()?;
        input.parse::<Token![:]>()?;
        d.requirements.push((words, input.parse()?));
    } else if look.peek(kw::points) {
        input.parse::<kw::points>()?;
        input.parse::<kw::apart>()?;
        d.points_apart = true;
    } else if look.peek(kw::scene) {
        let at = input.parse::<kw::scene>()?;
        once(&at, d.scene.replace(input.parse()?))?;
    } else if look.peek(kw::variant) {
        let at = input.parse::<kw::variant>()?;
        let key = input.parse()?;
        input.parse::<Token![=]>()?;
        let value = input.parse()?;
        let default = input.parse::<Option<Token![,]>>()?.is_some();
        if default {
            input.parse::<kw::default>()?;
        }
        once(&at, d.variant.replace((key, value, default)))?;
    } else if kind == Kind::Force {
        if !look.peek(kw::force) {
            return Err(look.error());
        }
        input.parse::<kw::force>()?;
        input.parse::<Token![:]>()?;
        let law = input.parse()?;
        input.parse::<kw::on>()?;
        d.forces.push((law, input.parse()?));
    } else {
        parse_constraint_item(input, d)?;
    }
    input.parse::<Token![;]>()?;
    Ok(())
}

fn parse_constraint_item(input: ParseStream<'_>, d: &mut Definition) -> syn::Result<()> {
    let look = input.lookahead1();
    if look.peek(kw::rows) {
        let at = input.parse::<kw::rows>()?;
        input.parse::<Token![:]>()?;
        let list;
        bracketed!(list in input);
        let rows: Vec<Ident> = Punctuated::<Ident, Token![,]>::parse_terminated(&list)?
            .into_iter()
            .collect();
        once(&at, (!d.rows.is_empty()).then_some(()))?;
        d.rows = rows;
    } else if look.peek(kw::phi) {
        let at = input.parse::<kw::phi>()?;
        input.parse::<Token![:]>()?;
        once(&at, d.phi.replace(input.parse()?))?;
        one_level(&at, d)?;
    } else if look.peek(kw::psi) {
        let at = input.parse::<kw::psi>()?;
        input.parse::<Token![:]>()?;
        once(&at, d.psi.replace(input.parse()?))?;
        one_level(&at, d)?;
    } else if look.peek(kw::measure) {
        input.parse::<kw::measure>()?;
        let name = input.parse()?;
        input.parse::<Token![:]>()?;
        d.measures.push((name, input.parse()?));
    } else if look.peek(kw::place) {
        let at = input.parse::<kw::place>()?;
        input.parse::<Token![:]>()?;
        once(&at, d.place.replace(input.parse()?))?;
    } else if look.peek(kw::component) {
        let at = input.parse::<kw::component>()?;
        let name = input.parse()?;
        input.parse::<Token![:]>()?;
        once(&at, d.component.replace((name, input.parse()?)))?;
    } else {
        return Err(look.error());
    }
    Ok(())
}

fn once<T>(at: &impl quote::ToTokens, previous: Option<T>) -> syn::Result<()> {
    match previous {
        Some(_) => Err(syn::Error::new_spanned(at, "given twice")),
        None => Ok(()),
    }
}

fn one_level(at: &impl quote::ToTokens, d: &Definition) -> syn::Result<()> {
    match d.phi.is_some() && d.psi.is_some() {
        true => Err(syn::Error::new_spanned(
            at,
            "a definition is either holonomic (`phi`) or nonholonomic (`psi`)",
        )),
        false => Ok(()),
    }
}

impl Parse for Param {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let doc = doc_lines(&input.call(Attribute::parse_outer)?)?;
        let name = input.parse()?;
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
            let list;
            bracketed!(list in input);
            let list = Punctuated::<ParamKind, Token![,]>::parse_terminated(&list)?;
            let mut numbers = Vec::new();
            let mut functions = Vec::new();
            for kind in list {
                match kind {
                    Self::Number(unit) => numbers.push(unit),
                    Self::Function(unit) => functions.push(unit),
                    _ => return Err(input.error("a list holds units, or functions of units")),
                }
            }
            return match (numbers.is_empty(), functions.is_empty()) {
                (false, true) => Ok(Self::Numbers(numbers)),
                (true, false) => Ok(Self::Functions(functions)),
                _ => Err(input.error("a list holds either units or functions of units")),
            };
        }
        let word: Ident = input.parse()?;
        match word.to_string().as_str() {
            "Point" => Ok(Self::Point(in_slot(input)?)),
            "Direction" => Ok(Self::Direction(in_slot(input)?)),
            "GroundLine" => Ok(Self::GroundLine),
            "Function" => {
                input.parse::<Token![<]>()?;
                let unit = unit(input.parse()?)?;
                input.parse::<Token![>]>()?;
                Ok(Self::Function(unit))
            }
            _ => Ok(Self::Number(unit(word)?)),
        }
    }
}

/// Units that a parameter may have: the variants of `joints::spec::Unit`.
pub const UNITS: [&str; 11] = [
    "Length",
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
];

fn unit(word: Ident) -> syn::Result<Ident> {
    match UNITS.iter().any(|u| word == u) {
        true => Ok(word),
        false => Err(syn::Error::new_spanned(
            &word,
            format!(
                "unknown kind `{word}`: expected `Point in slot`, `Direction in slot`, `GroundLine`, `Function<unit>` \
                 or a unit: {}",
                UNITS.join(", ")
            ),
        )),
    }
}

fn in_slot(input: ParseStream<'_>) -> syn::Result<Ident> {
    input.parse::<Token![in]>()?;
    input.parse()
}

struct Initial(Binding);

impl Parse for Initial {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let name = input.parse()?;
        input.parse::<Token![:]>()?;
        let word: Ident = input.parse()?;
        let kept = match word.to_string().as_str() {
            "Vector" => {
                in_slot(input)?;
                Kept::Vector
            }
            "PerLength" => Kept::Number,
            _ => {
                unit(word)?;
                Kept::Number
            }
        };
        input.parse::<Token![=]>()?;
        Ok(Self(Binding {
            name,
            value: input.parse()?,
            kept: Some(kept),
        }))
    }
}

fn doc_lines(attributes: &[Attribute]) -> syn::Result<Vec<String>> {
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
