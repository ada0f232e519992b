//! The names of a definition, with their values.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Ident;

use super::value::Value;
use crate::nearest::hint;
use crate::parse::Definition;
use crate::space::Space;

/// Names with their values, and a record of the names that were used.
#[derive(Default)]
pub(super) struct Names {
    values: BTreeMap<String, Value>,
    used: BTreeSet<String>,
}

impl Names {
    /// Adds a name.
    pub(super) fn declare(
        &mut self,
        definition: &Definition,
        name: &Ident,
        value: Value,
    ) -> syn::Result<()> {
        if definition.slots.contains(name) {
            return Err(syn::Error::new_spanned(
                name,
                format!("`{name}` is a body slot already: choose another name"),
            ));
        }
        match self.values.insert(name.to_string(), value) {
            Some(_) => Err(syn::Error::new_spanned(
                name,
                format!("`{name}` is defined twice"),
            )),
            None => Ok(()),
        }
    }

    /// Returns the value of a name, and records that the name is used.
    pub(super) fn value(&mut self, definition: &Definition, name: &Ident) -> syn::Result<Value> {
        let key = name.to_string();
        if let Some(value) = self.values.get(&key) {
            self.used.insert(key);
            return Ok(value.clone());
        }
        let known: Vec<&str> = self.values.keys().map(String::as_str).collect();
        let mut message = format!("unknown name `{key}`");
        if definition.slots.contains(name) {
            message.push_str(match definition.space {
                Space::Plane => ": it is a body slot, write `origin(…)` or `angle(…)` of it",
                Space::Space3 => ": it is a body slot, write `origin(…)` or `spin(…)` of it",
            });
        } else {
            message.push_str(&hint(&key, &known));
        }
        Err(syn::Error::new_spanned(name, message))
    }

    /// Rejects a definition that contains an unused name.
    pub(super) fn check_use(&self, definition: &Definition) -> syn::Result<()> {
        let params = definition.params.iter().map(|p| &p.name);
        let bindings = definition.bindings.iter().map(|b| &b.name);
        match params
            .chain(bindings)
            .find(|name| !self.used.contains(&name.to_string()))
        {
            Some(name) => Err(syn::Error::new_spanned(
                name,
                format!("`{name}` is never used: use it or leave it out"),
            )),
            None => Ok(()),
        }
    }
}
