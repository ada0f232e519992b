//! Several forms of one definition: `variant name { "value": expr, … }`.

use quote::format_ident;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Attribute, Expr, Ident, LitStr, Token, braced};

use super::kind::doc_lines;
use super::limits::FORMS;
use super::tree::{Binding, Definition, Variant, name};
use crate::names::{camel_case, kebab_case};

/// The forms of a definition.
pub(super) struct Forms {
    /// Key in a scene. The key is also the name of the expression in which the forms differ.
    key: Ident,
    /// Number of bindings before the forms.
    place: usize,
    all: Vec<Form>,
}

struct Form {
    doc: Vec<String>,
    value: LitStr,
    expression: Expr,
}

impl Parse for Form {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let doc = doc_lines(&input.call(Attribute::parse_outer)?)?;
        let value: LitStr = input.parse()?;
        let text = value.value();
        let is_letter = |c: char| c.is_ascii_lowercase();
        let is_name = text.starts_with(is_letter) && text.chars().all(|c| is_letter(c) || c == '-');
        if !is_name {
            return Err(syn::Error::new_spanned(
                &value,
                "the value of a variant has lower-case letters and hyphens, and starts with a letter",
            ));
        }
        input.parse::<Token![:]>()?;
        Ok(Self {
            doc,
            value,
            expression: input.parse()?,
        })
    }
}

impl Forms {
    /// Parses the part after `variant`. The argument `place` is the number of bindings before the
    /// forms.
    pub(super) fn parse(input: ParseStream<'_>, place: usize) -> syn::Result<Self> {
        let key = name(input)?;
        let list;
        braced!(list in input);
        let list = Punctuated::<Form, Token![,]>::parse_terminated(&list)?;
        let all: Vec<Form> = list.into_iter().collect();
        if !(2..=FORMS).contains(&all.len()) {
            return Err(syn::Error::new_spanned(
                &key,
                format!("`{key}` has {} values: write 2 to {FORMS}", all.len()),
            ));
        }
        for (k, form) in all.iter().enumerate() {
            if all[..k].iter().any(|other| other.value == form.value) {
                return Err(syn::Error::new_spanned(
                    &form.value,
                    "two variants have this value",
                ));
            }
        }
        Ok(Self { key, place, all })
    }

    /// Returns the definition of each form. The first form has the name of the definition. The name
    /// of every other form starts with its value.
    pub(super) fn of(self, d: &Definition) -> Vec<Definition> {
        let Self { key, place, all } = self;
        let of_form = |(k, form): (usize, Form)| {
            let mut own = d.clone();
            own.doc.extend(form.doc);
            own.bindings.insert(
                place,
                Binding {
                    name: key.clone(),
                    value: form.expression,
                    kept: None,
                },
            );
            let scene_type = || LitStr::new(&kebab_case(&d.name.to_string()), d.name.span());
            own.scene.get_or_insert_with(scene_type);
            if k > 0 {
                own.name = format_ident!("{}{}", camel_case(&form.value.value()), d.name);
            }
            own.variant = Some(Variant {
                key: key.clone(),
                value: form.value,
                default: k == 0,
            });
            own
        };
        all.into_iter().enumerate().map(of_form).collect()
    }
}
