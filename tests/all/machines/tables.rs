//! The tables that a run of a machine writes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use pfaff::dynamics::{OutputRequest, Plan, Sample};
use pfaff::model::{Registry, System};
use pfaff::report::OutputDirectory;
use pfaff::source::with_case;
use pfaff::{RunOptions, Study};
use serde_json::Value;

use crate::loads::imbalance;

/// The largest error, relative to the largest load of the machine (1 N·m counts as 1 N). If drives
/// determine the pose, it is accurate to about 1e-14 and one elimination loses few digits. The pose
/// of the tractor is integrated with a relative tolerance of 1e-8.
pub(super) const SHARE: f64 = 1e-9;

/// A CSV file by columns, without the units in their names; empty cells are not numbers.
#[derive(Default)]
struct Table(BTreeMap<String, Vec<Option<f64>>>);

impl Table {
    fn read(path: &Path) -> Self {
        let Ok(text) = fs::read_to_string(path) else {
            return Self::default();
        };
        let mut lines = text.lines();
        let names = lines.next().unwrap_or_default().split(',');
        let names = names.map(|name| name.split_once(" (").map_or(name, |x| x.0));
        let names: Vec<&str> = names.collect();
        let mut columns = vec![Vec::new(); names.len()];
        for line in lines {
            for (column, cell) in columns.iter_mut().zip(line.split(',')) {
                column.push((!cell.is_empty()).then(|| cell.parse().expect("a number")));
            }
        }
        Self(names.into_iter().map(str::to_owned).zip(columns).collect())
    }
}

/// A run with its tables.
pub(super) struct Run {
    pub(super) study: Study,
    pub(super) times: Vec<f64>,
    name: String,
    tables: Vec<Table>,
    summary: Value,
    /// The largest force or torque in the tables.
    largest: f64,
}

/// The folder of the scenes.
pub(super) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reports/first-minutes/machines")
}

/// The text of a scene with one of its load cases.
pub(super) fn scene(machine: &str, case: Option<&str>) -> String {
    let text = fs::read_to_string(folder().join(format!("{machine}.toml"))).expect("a scene");
    let registry = Registry::standard();
    case.map_or_else(
        || text.clone(),
        |case| with_case(text.clone(), case, &registry).unwrap_or_else(|e| panic!("{e:?}")),
    )
}

impl Run {
    pub(super) fn of(machine: &str, case: Option<&str>) -> Self {
        Self::of_text(machine, &scene(machine, case), case.unwrap_or_default())
    }

    /// Runs a scene as `pfaff simulate` does, and checks the balance of all loads on each body.
    pub(super) fn of_text(machine: &str, text: &str, label: &str) -> Self {
        let name = format!("{machine} {label}").trim().to_owned();
        let options = RunOptions::default();
        let study = Study::read("scene.toml", text, &Registry::standard(), &options);
        let study = study.unwrap_or_else(|e| panic!("{name}: {e}"));
        let folder = format!("pfaff-machines-{}-{name}", std::process::id());
        let path = std::env::temp_dir().join(folder.replace(' ', "-"));
        let directory = OutputDirectory::create(&path).expect("a folder");
        let run = study.simulate_into(&directory, |_| ControlFlow::Continue(()));
        run.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(path.join("report.html").exists(), "{name}");
        let files = ["trajectory.csv", "reactions.csv", "loads.csv"];
        let tables: Vec<Table> = files.iter().map(|f| Table::read(&path.join(f))).collect();
        let summary = fs::read_to_string(path.join("summary.json")).expect("a summary");
        for file in fs::read_dir(&path).expect("a folder").flatten() {
            if file.file_name().to_string_lossy().starts_with("body_") {
                balanced(&Table::read(&file.path()), &name);
            }
        }
        drop(directory);
        let _ = fs::remove_dir_all(&path);
        let times = tables[0].0[TIME].iter().flatten().copied().collect();
        let loads = tables[1..].iter().flat_map(|table| &table.0);
        let loads = loads.filter(|(name, _)| is_load(name));
        let largest = loads.flat_map(|(_, column)| column).flatten();
        let largest = largest.fold(0.0, |a: f64, x| a.max(x.abs()));
        let run = Self {
            study,
            times,
            name,
            tables,
            summary: serde_json::from_str(&summary).expect("a document"),
            largest,
        };
        run.check_balance();
        run
    }

    /// The sum of all loads on each body at each row, from multipliers, laws, weight and inertia.
    fn check_balance(&self) {
        let options = self.study.options.clone().expect("a run");
        let plan = Plan::new(&self.study.prepared, &options, &OutputRequest::default());
        let mut worst = 0.0_f64;
        let run = plan
            .expect("a plan")
            .simulate(|sample: &mut Sample<'_, '_>| {
                worst = worst.max(imbalance(&self.study, sample));
                Ok(ControlFlow::Continue(()))
            });
        assert!(run.is_ok(), "{}", self.name);
        assert!(worst < SHARE, "{}: loads differ by {worst:e}", self.name);
    }

    fn cell(&self, column: &str, row: usize) -> Option<f64> {
        let found = self.tables.iter().find_map(|table| table.0.get(column));
        let found = found.unwrap_or_else(|| panic!("{}: no column {column}", self.name));
        found[row]
    }

    /// The number of a cell, which must be determined.
    pub(super) fn value(&self, column: &str, row: usize) -> f64 {
        let cell = self.cell(column, row);
        cell.unwrap_or_else(|| panic!("{}: {column} is empty in row {row}", self.name))
    }

    /// The numbers of three columns.
    pub(super) fn vector(&self, of: &str, columns: [&str; 3], row: usize) -> [f64; 3] {
        columns.map(|column| self.value(&format!("{of}.{column}"), row))
    }

    /// Compares a load with its closed form.
    pub(super) fn equals(&self, column: &str, row: usize, expected: f64) {
        let (t, found) = (self.times[row], self.value(column, row));
        let share = (found - expected).abs() / self.largest;
        assert!(
            share <= SHARE,
            "{}: {column} at {t} s is {found} instead of {expected}: {share:e} of {}",
            self.name,
            self.largest
        );
    }

    /// Compares several components of a load, `x` and so on.
    pub(super) fn force(&self, of: &str, row: usize, expected: [f64; 3], components: &[&str]) {
        for component in components {
            let k = "xyz".find(&component[1..]).expect("a component");
            self.equals(&format!("{of}.{component}"), row, expected[k]);
        }
    }

    /// Checks which reactions are not unique throughout, by their columns in the table.
    pub(super) fn not_unique(&self, expected: &[&str]) {
        let empty = self.tables[1].0.iter().filter(|(_, column)| {
            let mut after = column.iter().skip(1);
            after.any(Option::is_none)
        });
        let owner = |name: &str| name.rsplit_once('.').map_or(name, |x| x.0).to_owned();
        let found: BTreeSet<String> = empty.map(|(name, _)| owner(name)).collect();
        let expected: BTreeSet<String> = expected.iter().map(|&x| x.to_owned()).collect();
        assert_eq!(found, expected, "{}", self.name);
    }

    /// Checks the redundancy of the rows at the start.
    pub(super) fn redundancy(&self, expected: usize) {
        let prepared = &self.study.prepared;
        let rows = prepared.mechanism.layout().rows();
        assert_eq!(rows - prepared.decision.rank, expected, "{}", self.name);
    }

    /// Checks that the peak of `summary.json` is the largest number of its column, within rounding.
    pub(super) fn peak(&self, owner: &str, component: &str) {
        let peak = &self.summary["reactions"][owner]["components"][component]["peak"];
        let value = peak["value"].as_f64().expect("a peak");
        let column = &self.tables[1].0[&format!("{owner}.{component}")];
        let largest = column
            .iter()
            .flatten()
            .fold(0.0, |a: f64, x| a.max(x.abs()));
        let error = (value.abs() - largest).abs();
        assert!(
            error <= SHARE * largest,
            "{}: {owner}.{component}",
            self.name
        );
    }
}

const TIME: &str = "t";

/// Whether a column is a load: not a time, length or rate.
fn is_load(name: &str) -> bool {
    let others = [".length", ".rate", ".angle"];
    name != TIME && !others.iter().any(|end| name.ends_with(end))
}

/// The loads on one body, about its centre of mass, sum to zero in each row.
fn balanced(table: &Table, name: &str) {
    let rows = table.0.values().next().map_or(0, Vec::len);
    assert!(rows > 0, "{name}");
    for row in 0..rows {
        let mut sums: BTreeMap<&str, f64> = BTreeMap::new();
        let mut largest = 0.0_f64;
        for (column, cells) in table.0.iter().filter(|(name, _)| *name != TIME) {
            let component = column.rsplit_once('.').expect("a component").1;
            let x = cells[row].expect("determined");
            *sums.entry(component).or_default() += x;
            largest = largest.max(x.abs());
        }
        for (component, sum) in sums {
            assert!(
                sum.abs() <= SHARE * largest,
                "{name}: {component} in row {row} is {sum}"
            );
        }
    }
}
