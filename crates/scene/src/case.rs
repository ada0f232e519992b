//! Load cases: named lists of values that replace values of the scene.

use std::str::FromStr;

use crate::field::Field;
use crate::findings::Findings;
use crate::key::{Key, Takes};
use crate::mistake::Mistake;
use crate::section::{self, tables};
use crate::table::Table;
use crate::template::{KeyError, Template};

/// A key of a scene with its new value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The key: a parameter, or a path such as `body.crank.mass`.
    pub key: String,
    /// The value: a number or an expression.
    pub expression: String,
}

impl FromStr for Setting {
    type Err = &'static str;

    /// Reads `NAME=EXPR`.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        // Names may contain the equals sign, but expressions may not.
        let (key, expression) = text.rsplit_once('=').unwrap_or_default();
        let [key, expression] = [key, expression].map(|part| part.trim().to_owned());
        if key.is_empty() || expression.is_empty() {
            return Err("need NAME=EXPR, as L=0.4 or L=\"2*25 mm\"");
        }
        Ok(Self { key, expression })
    }
}

impl Setting {
    /// Returns the text of a scene in which these values replace the values of the scene.
    ///
    /// # Errors
    /// [`KeyError`]: a key does not refer to a value of the scene, or the text is not TOML.
    ///
    /// ```
    /// use pfaff_scene::Setting;
    /// let scene = "parameters = { load = 3.0 }";
    /// let load: Setting = "load = 4".parse().unwrap();
    /// assert_eq!(Setting::replaced(scene, &[load]).unwrap(), "parameters = { load = 4 }");
    /// ```
    pub fn replaced(text: &str, settings: &[Self]) -> Result<String, KeyError> {
        let keys: Vec<&str> = settings.iter().map(|own| own.key.as_str()).collect();
        let template = Template::new(text, &keys)?;
        let expressions: Vec<&str> = settings.iter().map(|own| own.expression.as_str()).collect();
        Ok(template.with_expressions(&expressions))
    }
}

/// A load case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadCase {
    /// Name of the case.
    pub name: String,
    /// The values that replace values of the scene.
    pub settings: Vec<Setting>,
}

const SET: Key = Key::required("set", "a list of texts NAME=EXPR", Takes::Texts(0)).doc(
    "Values that replace those of the scene in this case, as \"load = 4 kN\" or \"force.wind.force[0] = 200\"",
);

/// Keys of a case, in addition to the name.
pub(crate) const KEYS: [Key; 2] = [section::NAME, SET];

/// Reads the load cases.
pub(crate) fn read(root: &mut Table, findings: &Findings) -> Vec<LoadCase> {
    let mut cases: Vec<LoadCase> = Vec::new();
    for (mut table, name) in tables(root, &section::CASE) {
        let field = table.required(&SET);
        let settings = field.as_ref().and_then(|field| settings(field, findings));
        if cases.iter().any(|known| known.name == name)
            && let Some(field) = &field
        {
            let message = format!(": the case `{name}` exists already");
            field.error(
                Mistake::Twice,
                message,
                "choose another name for one of them",
            );
        }
        table.close();
        cases.push(LoadCase {
            name,
            settings: settings.unwrap_or_default(),
        });
    }
    cases
}

fn settings(field: &Field, findings: &Findings) -> Option<Vec<Setting>> {
    let mut all = Vec::new();
    for item in field.items(SET.expected)? {
        let Some(text) = item.text(SET.expected) else {
            continue;
        };
        let setting: Setting = match text.parse() {
            Ok(setting) => setting,
            Err(expected) => {
                item.error(Mistake::NoValue, format!(": `{text}`"), expected);
                continue;
            }
        };
        let found = Template::new(findings.source.text(), &[setting.key.as_str()]);
        match found {
            // The reader of scenes reports errors of the text.
            Ok(_) | Err(KeyError::NotToml) => all.push(setting),
            Err(e) => item.error(e.code(), format!(": {e}"), "no such value"),
        }
    }
    Some(all)
}
