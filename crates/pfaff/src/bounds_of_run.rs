//! Bounds of the reactions during a run: `bounds.csv`, and the largest values over the run.

use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::sync::Arc;

use dynamics::{MotionFault, Plan, Sample};
use model::reaction::ConstraintGroup;
use model::words::{in_same_units, rounded};
use model::{ConfigurationAccuracy, ConstraintId, Mechanism, System};
use rayon::prelude::*;
use report::{
    BoundsTable, OutputDirectory, OutputFile, Quantity, ReactionColumn, TableError,
    write_open_bounds,
};
use scene::Scene;
use solvability::{
    BoundsError, ChosenValues, Elasticity, Group, Questions, ReactionBounds, Solution, Stretches,
    Term, analyse_with_progress,
};

use crate::documents::{
    Ending, ExtremeDocument, Gap, MagnitudeOfRunDocument, RangeOfRunDocument, RunBoundsDocument,
    RunDocument,
};
use crate::elasticity::{assumption, centres};
use crate::error::StudyError;
use crate::page::Band;
use crate::rows::{RowFault, RowSink};
use crate::tables_of_run::{TableRows, finished, table_units};
use crate::words::{Block, Cell, count};

/// File name of the table.
pub(crate) const BOUNDS: &str = "bounds.csv";

/// File name of the bounds of all columns. This file is removed at the end.
const ALL: &str = "bounds_0.csv";

/// Number of rows that are computed together.
const BATCH: usize = 64;

/// Largest number of values that are stored for the page.
const STORED: usize = 4_000_000;

/// Writer of `bounds.csv`. The bounds of several rows are computed in parallel.
pub(crate) struct BoundsOfRun<'m> {
    mechanism: &'m Mechanism,
    elasticity: &'m Elasticity,
    scene: &'m Scene,
    groups: Vec<Group>,
    columns: Vec<ReactionColumn>,
    /// The joints and drives of the columns.
    reactions: Vec<ConstraintId>,
    rtol: f64,
    /// The table with its directory, if it is written.
    table: Option<(&'m OutputDirectory, BoundsTable<OutputFile>)>,
    rows: TableRows,
    /// Whether rows between the rows of the table are computed for the page.
    is_pictured: bool,
    waiting: Vec<Instant>,
    found: FoundBounds,
}

/// The results over the run.
#[derive(Default)]
pub(crate) struct FoundBounds {
    /// The smallest and the largest value of each column, with their times. `None` without bounds.
    pub(crate) columns: Vec<Option<RangeOfRunDocument>>,
    /// The largest magnitudes of force and moment of each joint and drive.
    pub(crate) magnitudes: Vec<(ConstraintId, [Option<ExtremeDocument>; 2])>,
    /// Rows without bounds of some reactions.
    pub(crate) gap: Option<Gap>,
    /// The bounds of all columns at the rows of the run that are stored for the page.
    pub(crate) rows: Vec<(f64, Vec<[f64; 2]>)>,
    /// Whether the table exists.
    pub(crate) has_table: bool,
}

/// A row of the run whose bounds have not been computed yet.
struct Instant {
    t: f64,
    q: Vec<f64>,
    multipliers: ChosenValues<f64>,
    is_row: bool,
}

impl Instant {
    fn new(sample: &mut Sample<'_, '_>, is_row: bool) -> Result<Self, MotionFault> {
        Ok(Self {
            t: sample.t,
            q: sample.q.to_vec(),
            multipliers: sample.multipliers()?,
            is_row,
        })
    }
}

/// Bounds of numbers with their names.
type NamedEnds = Vec<(&'static str, [f64; 2])>;

/// The bounds at a row; NaN without bounds.
struct RowBounds {
    columns: Vec<[f64; 2]>,
    magnitudes: Vec<[f64; 2]>,
    reason: Option<String>,
}

impl<'m> BoundsOfRun<'m> {
    /// Creates a sink that writes the table.
    pub(crate) fn begin(
        directory: &'m OutputDirectory,
        (scene, mechanism): (&'m Scene, &'m Mechanism),
        elasticity: &'m Elasticity,
        columns: Vec<ReactionColumn>,
        plan: &Plan<'_>,
        rows: (TableRows, bool),
    ) -> Result<Self, StudyError> {
        let table = BoundsTable::new(directory.scratch(ALL)?, &columns, table_units(scene))?;
        Ok(Self {
            table: Some((directory, table)),
            ..Self::new((scene, mechanism), elasticity, columns, plan, rows)
        })
    }

    /// Creates a sink without a table. The second part of `rows` states whether the bounds of all
    /// rows are stored.
    pub(crate) fn new(
        (scene, mechanism): (&'m Scene, &'m Mechanism),
        elasticity: &'m Elasticity,
        columns: Vec<ReactionColumn>,
        plan: &Plan<'_>,
        (rows, is_pictured): (TableRows, bool),
    ) -> Self {
        let of_columns = columns.iter().filter_map(|column| match column.quantity {
            Quantity::Component(id, _) => Some(id),
            Quantity::Group(..) => None,
        });
        let mut reactions: Vec<ConstraintId> = of_columns.collect();
        reactions.dedup();
        Self {
            mechanism,
            elasticity,
            scene,
            groups: plan.groups.clone(),
            reactions,
            rtol: plan.options().rtol,
            table: None,
            rows,
            is_pictured,
            waiting: Vec::new(),
            found: FoundBounds {
                columns: vec![None; columns.len()],
                ..FoundBounds::default()
            },
            columns,
        }
    }

    /// Creates a sink without a table that computes the largest magnitudes of these reactions.
    pub(crate) fn of_magnitudes(
        parts: (&'m Scene, &'m Mechanism),
        elasticity: &'m Elasticity,
        reactions: Vec<ConstraintId>,
        plan: &Plan<'_>,
    ) -> Self {
        let all = TableRows::new(1, plan.options().t_end);
        Self {
            reactions,
            ..Self::new(parts, elasticity, Vec::new(), plan, (all, false))
        }
    }

    /// Computes the bounds at a sample in this thread.
    pub(crate) fn see(&mut self, sample: &mut Sample<'_, '_>) -> Result<(), MotionFault> {
        let instant = Instant::new(sample, true)?;
        let bounds = self.at(&instant);
        self.found.note(instant.t, &bounds, &self.reactions);
        Ok(())
    }

    /// Returns the bounds of all rows, with their times.
    pub(crate) fn into_rows(self) -> Vec<(f64, Vec<[f64; 2]>)> {
        self.found.rows
    }

    /// Returns the columns and the results, after the end.
    pub(crate) fn found(&self) -> (&[ReactionColumn], &FoundBounds) {
        (&self.columns, &self.found)
    }

    /// Computes the bounds of the waiting rows and writes them.
    fn compute(&mut self) -> Result<(), TableError> {
        let waiting = std::mem::take(&mut self.waiting);
        let each = waiting
            .par_iter()
            .map(in_same_units(|instant| self.at(instant)));
        let each: Vec<RowBounds> = each.collect();
        for (instant, bounds) in waiting.iter().zip(each) {
            let t = instant.t;
            self.found.note(t, &bounds, &self.reactions);
            if instant.is_row
                && let Some((_, table)) = &mut self.table
            {
                table.row(t, &bounds.columns)?;
            }
            let stored = self.found.rows.len() * self.columns.len();
            // Without a table, all rows are stored.
            if self.is_pictured && (stored < STORED || self.table.is_none()) {
                self.found.rows.push((t, bounds.columns));
            }
        }
        Ok(())
    }

    /// Computes the bounds at a row.
    fn at(&self, instant: &Instant) -> RowBounds {
        let mut row = RowBounds {
            columns: vec![[f64::NAN; 2]; self.columns.len()],
            magnitudes: vec![[f64::NAN; 2]; self.reactions.len()],
            reason: None,
        };
        let lambda = &instant.multipliers;
        if lambda.as_chosen().iter().any(|l| l.is_nan()) {
            row.reason = Some("the reactions have no values at this instant".to_owned());
            return row;
        }
        let known = match instant.t {
            t if t == self.mechanism.layout().start_time => ConfigurationAccuracy::AsStored,
            _ => ConfigurationAccuracy::To(self.rtol),
        };
        let (t, q) = (instant.t, &instant.q);
        let analysis = match analyse_with_progress(self.mechanism, t, q, known, |_| ()) {
            Ok(analysis) => analysis,
            Err(e) => {
                row.reason = Some(e.to_string());
                return row;
            }
        };
        if !analysis.decision.is_decided() {
            row.reason = Some(BoundsError::Rank.to_string());
            return row;
        }
        if analysis.decision.redundancy != lambda.dropped().len() {
            row.reason =
                Some("the rank at this instant differs from that of the motion".to_owned());
            return row;
        }
        let questions = Questions::new(self.mechanism, q, Arc::new(analysis));
        let solution = Solution {
            acceleration: Vec::new(),
            multipliers: lambda.clone(),
            no_finite: Vec::new(),
        };
        let elasticity = Elasticity {
            centres: centres(self.scene, self.mechanism, q),
            ..self.elasticity.clone()
        };
        let found = questions.bounds(&solution, &elasticity);
        let mut of_group = None;
        for (column, ends) in self.columns.iter().zip(&mut row.columns) {
            match self.ends(&found, column, &mut of_group) {
                Ok(bounds) => *ends = bounds,
                Err(e) => {
                    let owner = &column.column.owner;
                    row.reason.get_or_insert_with(|| format!("`{owner}`: {e}"));
                }
            }
        }
        for (&id, magnitudes) in self.reactions.iter().zip(&mut row.magnitudes) {
            match found.largest_magnitudes(id) {
                Ok(largest) => *magnitudes = largest.map(|size| size.unwrap_or(f64::NAN)),
                Err(e) => {
                    let name = &self.mechanism.layout().groups[id.0].name;
                    row.reason.get_or_insert_with(|| format!("`{name}`: {e}"));
                }
            }
        }
        row
    }

    /// Returns the bounds of a column. The numbers of the last group are stored.
    fn ends(
        &self,
        found: &ReactionBounds<'_, '_>,
        column: &ReactionColumn,
        of_group: &mut Option<(usize, NamedEnds)>,
    ) -> Result<[f64; 2], BoundsError> {
        let numbers = |group: &Group| {
            let numbers = found.group(group)?.into_iter();
            let numbers = numbers.map(|(name, bounds)| {
                let ends = [bounds.lowest, bounds.highest];
                let complete = bounds.complete.then_some((name, ends));
                complete.ok_or(BoundsError::Many)
            });
            numbers.collect::<Result<Vec<_>, _>>()
        };
        match column.quantity {
            Quantity::Component(reaction, name) => {
                let term = Term {
                    reaction,
                    component: name.to_owned(),
                    coefficient: 1.0,
                };
                let own = numbers(&Group::Combination(vec![term]))?;
                Ok(own.first().map_or([f64::NAN; 2], |(_, ends)| *ends))
            }
            Quantity::Group(k, name) => {
                if of_group.as_ref().is_none_or(|(known, _)| *known != k) {
                    *of_group = Some((k, numbers(&self.groups[k])?));
                }
                let own = of_group.iter().flat_map(|(_, numbers)| numbers);
                let mut own = own.filter(|(known, _)| *known == name);
                Ok(own.next().map_or([f64::NAN; 2], |(_, ends)| *ends))
            }
        }
    }
}

impl FoundBounds {
    /// Returns the bounds of a column at these times (s). Without bounds, the numbers are NaN.
    pub(crate) fn ends(&self, column: usize, times: &[f64]) -> Vec<[f64; 2]> {
        let ends = times.iter().map(|time| {
            let at = self.rows.binary_search_by(|(t, _)| t.total_cmp(time));
            at.map_or([f64::NAN; 2], |row| self.rows[row].1[column])
        });
        ends.collect()
    }

    /// Returns the bounds of the components of joints and drives at the times of the page (s).
    pub(crate) fn bands(
        &self,
        columns: &[ReactionColumn],
        stretches: &Stretches,
        times: &[f64],
    ) -> Vec<Band> {
        let band = |(k, column): (usize, &ReactionColumn)| {
            let Quantity::Component(id, component) = column.quantity else {
                return None;
            };
            column.quantity.open(stretches)?;
            Some(Band {
                id,
                component,
                ends: self.ends(k, times),
            })
        };
        columns.iter().enumerate().filter_map(band).collect()
    }

    /// Returns the largest magnitudes of the reactions that are not unique on the whole run.
    pub(crate) fn open(
        &self,
        verdicts: &Stretches,
    ) -> impl Iterator<Item = &(ConstraintId, [Option<ExtremeDocument>; 2])> {
        let is_open = |id: ConstraintId| {
            let found = verdicts.reactions.get(id.0);
            found.is_some_and(|found| !found.whole.of_run().is_unique())
        };
        let all = self.magnitudes.iter();
        all.filter(move |(id, _)| is_open(*id))
    }

    fn note(&mut self, time: f64, bounds: &RowBounds, reactions: &[ConstraintId]) {
        if let Some(reason) = &bounds.reason {
            let first = || Gap::at(time, reason.clone());
            self.gap.get_or_insert_with(first).rows += 1;
        }
        for (own, ends) in self.columns.iter_mut().zip(&bounds.columns) {
            if !ends[0].is_nan() {
                let at = RangeOfRunDocument::at(time, *ends);
                own.get_or_insert(at).include(at);
            }
        }
        if self.magnitudes.is_empty() {
            self.magnitudes = reactions.iter().map(|id| (*id, [None; 2])).collect();
        }
        for ((_, own), sizes) in self.magnitudes.iter_mut().zip(&bounds.magnitudes) {
            for (own, &value) in own.iter_mut().zip(sizes) {
                if !value.is_nan() && own.is_none_or(|own| value > own.value) {
                    *own = Some(ExtremeDocument::new(value, time));
                }
            }
        }
    }
}

/// Adds the bounds of a run to its document.
pub(crate) fn add_to(
    document: &mut RunDocument,
    mechanism: &Mechanism,
    elasticity: &Elasticity,
    found: Option<(&[ReactionColumn], &FoundBounds)>,
    verdicts: Option<&Stretches>,
) {
    let layout = mechanism.layout();
    let reactions = document.reactions.0.iter().zip(&layout.groups);
    let open = reactions.filter(|((_, r), _)| r.verdict() != "unique");
    let open: Vec<&ConstraintGroup> = open.map(|(_, group)| group).collect();
    let within = elasticity.within.as_ref();
    let name = |id: &ConstraintId| layout.groups[id.0].name.clone();
    document.bounds = Some(RunBoundsDocument {
        assumption: assumption(&open, document.data.tolerance.is_some(), within),
        rigid: elasticity.rigid.iter().map(name).collect(),
        within: within.map(|range| range.factor),
        gap: found.and_then(|(_, found)| found.gap.clone()),
    });
    let Some(((columns, found), verdicts)) = found.zip(verdicts) else {
        return;
    };
    let columns = columns.iter().zip(&found.columns);
    for (column, range) in columns.filter(|(column, _)| column.quantity.open(verdicts).is_some()) {
        match column.quantity {
            Quantity::Component(id, name) => {
                let own = document.reactions.0.get_mut(id.0);
                let mut own = own.into_iter().flat_map(|(_, r)| &mut r.components.0);
                let number = own.find(|(known, _)| known == name);
                if let Some((_, number)) = number {
                    number.bounds = *range;
                }
            }
            Quantity::Group(k, name) => {
                let Some((_, group)) = document.groups.0.get_mut(k) else {
                    continue;
                };
                let number = group
                    .components
                    .0
                    .iter_mut()
                    .find(|(known, _)| known == name);
                let own = number.map_or(&mut group.bounds, |(_, number)| &mut number.bounds);
                *own = *range;
            }
        }
    }
    for (id, [force, moment]) in found.open(verdicts) {
        if let Some((_, reaction)) = document.reactions.0.get_mut(id.0) {
            let magnitude = MagnitudeOfRunDocument::new(*force, *moment);
            reaction.magnitude_at_most = Some(magnitude);
        }
    }
}

/// Number of lines of the table of the largest loads.
const LARGEST: usize = 12;

/// Lists the upper bounds of the largest loads over the run. The largest forces come first.
pub(crate) fn largest_loads(
    bounds: &RunBoundsDocument,
    mut known: Vec<(String, MagnitudeOfRunDocument)>,
) -> Vec<Block> {
    let size = |x: Option<ExtremeDocument>| x.map_or(0.0, |x| x.value);
    known.sort_by(|(_, a), (_, b)| {
        let by_moment = size(b.moment).total_cmp(&size(a.moment));
        size(b.force).total_cmp(&size(a.force)).then(by_moment)
    });
    if known.is_empty() {
        return Vec::new();
    }
    let cells = |x: Option<ExtremeDocument>, unit| {
        [
            Cell::quantity(x.map(|x| x.value), unit),
            Cell::quantity(x.map(|x| x.time), "s"),
        ]
    };
    let lines = known.iter().take(LARGEST).map(|(name, most)| {
        let [force, force_at] = cells(most.force, "N");
        let [moment, moment_at] = cells(most.moment, "N·m");
        [name.as_str().into(), force, force_at, moment, moment_at]
    });
    let columns = ["reaction", "force at most", "at", "moment at most", "at"];
    let mut out = vec![Block::table(columns, lines)];
    let mut say = |lead: &str, text: &str| out.push(Block::after(lead, text));
    if known.len() > LARGEST {
        say("", "the JSON document contains the others");
    }
    if let Some(gap) = &bounds.gap {
        let (first, reason) = (rounded(gap.first), &gap.reason);
        let rows = count(gap.rows, "row", "rows");
        say(
            "warning: ",
            &format!(
                "some reactions have no bounds in {rows}, the first at t = {first} s: {reason}"
            ),
        );
    }
    say("valid ", &bounds.assumption);
    out
}

impl RowSink for BoundsOfRun<'_> {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        let is_row = self.rows.take(sample.t);
        if is_row || self.is_pictured {
            self.waiting.push(Instant::new(sample, is_row)?);
        }
        if self.waiting.len() == BATCH {
            self.compute()?;
        }
        Ok(ControlFlow::Continue(()))
    }

    fn end(&mut self, verdicts: Option<&Stretches>, ending: &Ending<'_>) -> Result<(), StudyError> {
        self.compute()?;
        let (Some((directory, table)), Some(stretches)) = (self.table.take(), verdicts) else {
            return Ok(());
        };
        let mut all = table.finish()?;
        let mut open = self.columns.iter();
        if !open.any(|column| column.quantity.open(stretches).is_some()) {
            return Ok(());
        }
        let mut out = directory.file(BOUNDS)?;
        let all: BufReader<File> = BufReader::new(all.written()?);
        write_open_bounds(all, &mut out, &self.columns, stretches)?;
        finished(out, ending)?;
        self.found.has_table = true;
        Ok(())
    }
}
