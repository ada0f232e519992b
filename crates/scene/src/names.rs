//! Names of bodies, of joints, drives and forces, and of groups: each space has each name once.

use std::collections::BTreeMap;
use std::ops::Range;

use model::BuildError;

use crate::body::GROUND;
use crate::findings::Findings;
use crate::locate;
use crate::source_map::{Entry, SourceMap};

/// Names of everything, complete or not, in their spaces.
#[derive(Default)]
pub(crate) struct Names {
    pub(crate) bodies: Vec<Entry>,
    pub(crate) elements: Vec<Entry>,
    pub(crate) groups: Vec<Entry>,
}

impl Names {
    /// Reports names that are used twice, and `ground`.
    pub(crate) fn check(&self, map: &SourceMap, findings: &mut Findings) {
        for entry in self.bodies.iter().chain(&self.elements) {
            if entry.name == GROUND {
                findings.error(
                    entry.name_span(),
                    BuildError::Ground.to_string(),
                    "choose another name",
                );
            }
        }
        for space in [&self.bodies, &self.elements, &self.groups] {
            let mut uses: BTreeMap<&str, Vec<Range<usize>>> = BTreeMap::new();
            for entry in space.iter().filter(|entry| entry.name != GROUND) {
                uses.entry(&entry.name).or_default().push(entry.name_span());
            }
            for (name, uses) in uses {
                let name = name.to_owned();
                let error = BuildError::DuplicateName { name };
                for diagnostic in locate::duplicates(map, &uses, &error) {
                    findings.report(diagnostic);
                }
            }
        }
    }
}
