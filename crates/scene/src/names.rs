//! Names of items. There are three name spaces: bodies, markers and measures; joints, drives and
//! forces; and groups. In each name space, a name may occur only once.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ops::Range;

use model::{BuildError, FrameState, MeasureKind, SpaceKind};

use crate::body::GROUND;
use crate::findings::Findings;
use crate::locate;
use crate::mistake::Mistake;
use crate::source_map::SourceMap;
use crate::table::Table;

/// All names in their name spaces, including the names in incomplete tables.
pub(crate) struct Names {
    /// Bodies, markers and measures; they share the columns of one output table.
    pub(crate) bodies: Vec<NameUse>,
    pub(crate) measures: Vec<NameUse>,
    pub(crate) elements: Vec<NameUse>,
    pub(crate) groups: Vec<NameUse>,
    /// The space of the scene, which determines the names of its columns.
    pub(crate) space: SpaceKind,
    /// Whether there are columns of accelerations and of derivatives of measures.
    pub(crate) rates: bool,
    /// Whether there are columns of roll, pitch and yaw.
    pub(crate) angles: bool,
}

/// A name and its position in the text.
pub(crate) struct NameUse {
    name: String,
    span: Range<usize>,
}

impl NameUse {
    pub(crate) fn of(name: &str, table: &Table) -> Self {
        Self {
            name: name.to_owned(),
            span: table.span_of("name"),
        }
    }
}

/// The name of the time column.
const TIME: &str = "t";

impl Names {
    pub(crate) fn of(space: SpaceKind) -> Self {
        Self {
            bodies: Vec::new(),
            measures: Vec::new(),
            elements: Vec::new(),
            groups: Vec::new(),
            space,
            rates: false,
            angles: false,
        }
    }

    /// Reports measures whose name is also the name of another column of the trajectory.
    fn check_columns(&self, findings: &Findings) {
        let rates = self.space.accelerations().iter().filter(|_| self.rates);
        let angles = FrameState::ANGLES.iter().filter(|_| self.angles);
        let columns = self.space.columns().iter().chain(rates).chain(angles);
        let columns: Vec<&str> = columns.copied().collect();
        let of_measures = MeasureKind::COLUMNS.iter().skip(1);
        let of_measures: Vec<&str> = of_measures.filter(|_| self.rates).copied().collect();
        let measures: HashSet<&str> = self.measures.iter().map(|m| m.name.as_str()).collect();
        let places = self.bodies.iter().map(|place| place.name.as_str());
        let places: HashSet<&str> = places.filter(|name| !measures.contains(name)).collect();
        for NameUse { name, span } in &self.measures {
            let is_column = |(owner, column): (&str, &str)| {
                places.contains(owner) && columns.contains(&column)
                    || measures.contains(owner) && of_measures.contains(&column)
            };
            if name == TIME || name.rsplit_once('.').is_some_and(is_column) {
                let message =
                    format!("measure `{name}` has the name of another column of `trajectory.csv`");
                findings.error(
                    Mistake::ReservedName,
                    span.clone(),
                    message,
                    "choose another name",
                );
            }
        }
    }

    /// Reports names that are used twice, and `ground`.
    pub(crate) fn check(&self, map: &SourceMap, findings: &Findings) {
        for used in self.bodies.iter().chain(&self.elements) {
            if used.name == GROUND {
                findings.error(
                    BuildError::Ground.code(),
                    used.span.clone(),
                    BuildError::Ground.to_string(),
                    "choose another name",
                );
            }
        }
        self.check_columns(findings);
        for space in [&self.bodies, &self.elements, &self.groups] {
            let named = || space.iter().filter(|used| used.name != GROUND);
            let mut seen = HashSet::with_capacity(space.len());
            let again = named().map(|used| used.name.as_str());
            let twice: BTreeSet<&str> = again.filter(|name| !seen.insert(*name)).collect();
            if twice.is_empty() {
                continue;
            }
            let mut uses: BTreeMap<&str, Vec<Range<usize>>> = BTreeMap::new();
            for used in named().filter(|used| twice.contains(used.name.as_str())) {
                uses.entry(&used.name).or_default().push(used.span.clone());
            }
            for (name, uses) in uses {
                if findings.is_full() {
                    return;
                }
                let name = name.to_owned();
                let error = BuildError::DuplicateName { name };
                for diagnostic in locate::duplicates(map, &uses, &error) {
                    findings.report(diagnostic);
                }
            }
        }
    }
}
