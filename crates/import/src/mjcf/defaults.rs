//! `<default>`: nested classes of attributes.

use std::collections::HashMap;

use crate::files::Files;
use crate::findings::{Fault, Findings};
use crate::xml::{Element, Value};

#[derive(Default)]
pub(super) struct Defaults<'a> {
    classes: Vec<Class<'a>>,
    by_name: HashMap<String, usize>,
}

#[derive(Default)]
struct Class<'a> {
    around: Option<usize>,
    /// Values by element and attribute.
    values: HashMap<(&'a str, &'a str), Value<'a>>,
}

impl<'a> Defaults<'a> {
    pub(super) fn read(
        files: &'a Files<'a>,
        sections: &[Element<'a>],
        findings: &mut Findings,
    ) -> Self {
        let mut defaults = Self::default();
        defaults.classes.push(Class::default());
        defaults.by_name.insert("main".to_owned(), 0);
        for section in sections
            .iter()
            .filter(|section| section.name() == "default")
        {
            if let Some(name) = section.attribute("class") {
                defaults.by_name.insert(name.text.trim().to_owned(), 0);
            }
            defaults.class(files, *section, 0, findings);
        }
        defaults
    }

    /// Reads the attributes of one class, and the nested classes. The limit on the depth of the
    /// file also limits the nesting of classes.
    fn class(
        &mut self,
        files: &'a Files<'a>,
        section: Element<'a>,
        class: usize,
        findings: &mut Findings,
    ) {
        for child in files.children(section, findings) {
            if child.name() != "default" {
                for (key, value) in child.attributes() {
                    // `joint` also applies to free joints, which do not have these attributes.
                    self.classes[class]
                        .values
                        .insert((child.name(), key), value);
                }
                continue;
            }
            let Some(name) = child.attribute("class") else {
                findings.missing(child, "a `class`: only the first default may omit it");
                continue;
            };
            let new = self.classes.len();
            let around = Some(class);
            self.classes.push(Class {
                around,
                values: HashMap::new(),
            });
            if self
                .by_name
                .insert(name.text.trim().to_owned(), new)
                .is_some()
            {
                let message = format!("the class `{}` is defined twice", name.text);
                findings.at(Fault::Twice, &name, message);
            }
            self.class(files, child, new, findings);
        }
    }

    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Returns an attribute of a class, or of the nearest surrounding class that has the attribute.
    pub(super) fn get(&self, class: usize, element: &str, key: &str) -> Option<Value<'a>> {
        let mut at = Some(class);
        while let Some(class) = at {
            let class = self.classes.get(class)?;
            if let Some(value) = class.values.get(&(element, key)) {
                return Some(value.clone());
            }
            at = class.around;
        }
        None
    }
}
