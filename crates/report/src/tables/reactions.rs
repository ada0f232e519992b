//! `reactions.csv`: force and torque on the first body of joints and drives, and the components of
//! groups. It is not known until the end of the run which cells of the table have a determined
//! value. During the run, all values belong to one of the possible solutions for the multipliers.
//! The table of this solution is `choice.csv`.

use std::io::{self, BufRead, Write};

use model::{ConstraintId, Mechanism, Reaction, SpaceKind, System};
use solvability::{ChosenValues, Group, Stretches, Value, VerdictTrack};

use super::{Column, Table, TableError};
use model::words::SceneUnits;

/// The joints and drives that are written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// All reactions.
    #[default]
    All,
    /// Reactions of these joints and drives, in the order of the rows of C. The order of the names
    /// has no effect.
    Names(Vec<String>),
}

impl Selection {
    /// Indices of the selected joints and drives.
    fn places(&self, mechanism: &Mechanism) -> Result<Vec<usize>, TableError> {
        let groups = &mechanism.layout().groups;
        let Self::Names(names) = self else {
            return Ok((0..groups.len()).collect());
        };
        if let Some(name) = names.iter().find(|n| groups.iter().all(|g| g.name != **n)) {
            let known: Vec<&str> = groups.iter().map(|g| g.name.as_str()).collect();
            return Err(TableError::UnknownReaction {
                name: name.clone(),
                known: known.join(", "),
            });
        }
        Ok((0..groups.len())
            .filter(|&k| names.contains(&groups[k].name))
            .collect())
    }
}

/// The columns of the joint or drive with this index, in the order of the rows of C.
///
/// # Panics
/// Panics if the index does not exist.
#[must_use]
pub fn reaction_columns(mechanism: &Mechanism, place: usize) -> Vec<Column> {
    let group = &mechanism.layout().groups[place];
    let numbers = group.space.components().iter().copied();
    numbers
        .chain(group.spec.component)
        .map(|number| Column {
            owner: group.name.clone(),
            kind: "reaction",
            number,
            unit: mechanism.layout().load_unit(ConstraintId(place), number),
        })
        .collect()
}

/// The quantity in a column of reactions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A component of a joint or drive, or the named component of its definition.
    Component(ConstraintId, &'static str),
    /// A component of a group, with the index of the group.
    Group(usize, &'static str),
}

impl Quantity {
    /// Returns the verdicts on the quantity. Returns `None` if the quantity is zero under any load.
    #[must_use]
    pub fn verdicts<'s>(&self, stretches: &'s Stretches) -> Option<&'s VerdictTrack> {
        match self {
            Self::Component(id, name) => stretches.reactions.get(id.0)?.component(name),
            Self::Group(k, name) => {
                let numbers = &stretches.groups.get(*k)?.numbers;
                let named = numbers.iter().find(|(known, _)| known == name);
                named.map(|(_, track)| track)
            }
        }
    }

    /// The verdicts on the quantity, if it is not determined on at least one interval.
    #[must_use]
    pub fn open<'s>(&self, stretches: &'s Stretches) -> Option<&'s VerdictTrack> {
        let track = self.verdicts(stretches)?;
        let mut own = track.stretches().iter();
        own.any(|stretch| !stretch.verdict.is_unique())
            .then_some(track)
    }

    /// Returns a value of this quantity at a time, and whether the quantity is determined on the
    /// interval that contains the time.
    #[must_use]
    pub fn value(&self, stretches: &Stretches, t: f64, number: f64) -> Value {
        let track = self.verdicts(stretches);
        track.map_or_else(|| Value::unique(number), |track| track.value(t, number))
    }
}

/// A column of reactions.
#[derive(Clone, Debug, PartialEq)]
pub struct ReactionColumn {
    /// Name of the column.
    pub column: Column,
    /// Quantity in the column.
    pub quantity: Quantity,
    /// Whether the value is sensitive to the last digits of the data.
    pub fragile: bool,
}

impl ReactionColumn {
    /// Name of the quantity.
    #[must_use]
    pub fn plain_name(&self) -> String {
        match (&self.quantity, self.column.number) {
            (Quantity::Group(..), "sum") => self.column.owner.clone(),
            _ => self.column.to_string(),
        }
    }

    /// Name in tables: the name of the quantity, with a mark if the value is fragile.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.plain_name();
        if self.fragile {
            format!("{name}.fragile")
        } else {
            name
        }
    }
}

/// Returns the columns of all selected joints and drives, followed by the columns of the groups.
/// The groups are given with their names.
///
/// # Errors
/// [`TableError::UnknownReaction`]: a selected name does not exist.
pub fn columns_of_reactions(
    mechanism: &Mechanism,
    selection: &Selection,
    groups: &[(String, Group)],
    is_fragile: impl Fn(&Quantity) -> bool,
) -> Result<Vec<ReactionColumn>, TableError> {
    let mut columns = Vec::new();
    for k in selection.places(mechanism)? {
        let id = ConstraintId(k);
        let own = reaction_columns(mechanism, k).into_iter();
        columns.extend(own.map(|column| (Quantity::Component(id, column.number), column)));
    }
    for (k, (name, group)) in groups.iter().enumerate() {
        let numbers = group.number_names(mechanism.space()).iter();
        columns.extend(numbers.map(|number| {
            let column = Column {
                owner: name.clone(),
                kind: "group",
                number,
                unit: match mechanism.space().load_unit(number) {
                    Some(unit) => unit,
                    None => group.unit(mechanism.layout()).unwrap_or_default(),
                },
            };
            (Quantity::Group(k, number), column)
        }));
    }
    let column = |(quantity, column): (Quantity, Column)| ReactionColumn {
        fragile: is_fragile(&quantity),
        column,
        quantity,
    };
    Ok(columns.into_iter().map(column).collect())
}

/// `t`, then for each joint and drive `<name>.Fx, .Fy, .T`, in space
/// `.Fx, .Fy, .Fz, .Tx, .Ty, .Tz`, and the named component of its definition, if it has one: `.N`
/// of a knife edge, `.drive` of a drive (s, N, N·m); then the components of groups. All values
/// belong to one of the possible solutions for the multipliers.
pub struct ReactionTable<W: Write> {
    table: Table<W>,
    n_reactions: usize,
    columns: Vec<ReactionColumn>,
    /// Buffer for one row, reused.
    values: Vec<f64>,
    space: SpaceKind,
}

impl<W: Write> ReactionTable<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(
        name: &'static str,
        out: W,
        mechanism: &Mechanism,
        columns: Vec<ReactionColumn>,
        units: Option<SceneUnits>,
    ) -> Result<Self, TableError> {
        let named = columns.iter();
        let named = named.map(|column| (column.name(), column.column.unit));
        Ok(Self {
            table: Table::over_time(name, out, named, units)?,
            n_reactions: mechanism.layout().groups.len(),
            space: mechanism.space(),
            values: Vec::with_capacity(columns.len() + 1),
            columns,
        })
    }

    /// Columns of the table, without `t`.
    #[must_use]
    pub fn columns(&self) -> &[ReactionColumn] {
        &self.columns
    }

    /// Writes the reactions at time t and returns the values of the row, without t. `reactions`
    /// contains **all** joints and drives, in the order of their rows. The table writes only the
    /// selected joints and drives. `groups` contains all components of all groups.
    ///
    /// # Errors
    /// - [`TableError::Length`]: the values belong to another mechanism; nothing is written.
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(
        &mut self,
        t: f64,
        reactions: &ChosenValues<Reaction>,
        groups: &ChosenValues<f64>,
    ) -> Result<&[f64], TableError> {
        let reactions = reactions.as_chosen();
        self.table
            .check_length(t, "reactions", reactions.len(), self.n_reactions)?;
        self.values.clear();
        self.values.push(t);
        let groups = groups.as_chosen();
        let own = numbers_of_columns(&self.columns, self.space, reactions, groups);
        self.values.extend(own);
        self.table.row_with_gaps(&self.values)?;
        Ok(&self.values[1..])
    }

    /// Writes the buffer and returns the writer with the columns.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn finish(self) -> Result<(W, Vec<ReactionColumn>), TableError> {
        Ok((self.table.finish()?, self.columns))
    }
}

/// The values of columns. `reactions` contains all joints and drives, and `groups` contains all
/// components of all groups. A value that does not exist is NaN.
pub fn numbers_of_columns(
    columns: &[ReactionColumn],
    space: SpaceKind,
    reactions: &[Reaction],
    groups: &[f64],
) -> impl Iterator<Item = f64> {
    let mut of_groups = groups.iter();
    columns.iter().map(move |column| match column.quantity {
        Quantity::Component(id, name) => {
            let own = reactions.get(id.0);
            own.map_or(f64::NAN, |own| reaction_component(own, space, name))
        }
        Quantity::Group(..) => of_groups.next().copied().unwrap_or(f64::NAN),
    })
}

/// Returns the component of a reaction with this name, including the named component of the
/// definition (N, N·m). Returns NaN if the reaction has no component with this name.
#[must_use]
pub fn reaction_component(reaction: &Reaction, space: SpaceKind, name: &str) -> f64 {
    match space.component(name) {
        Some(k) => reaction.components(space).nth(k).unwrap_or(f64::NAN),
        None => reaction.component.unwrap_or(f64::NAN),
    }
}

/// Copies a table of all values. Values that are not determined on their interval, and values that
/// do not exist, become empty cells. Returns whether a cell is empty.
///
/// # Errors
/// [`TableError::Write`]: reading or writing failed.
pub fn write_determined(
    all: impl BufRead,
    out: impl Write,
    columns: &[ReactionColumn],
    stretches: &Stretches,
) -> Result<bool, TableError> {
    let copied = copy(all, None::<&[u8]>, out, columns, stretches);
    copied.map_err(|source| TableError::Write {
        table: "reactions.csv",
        source,
    })
}

/// Copies a table of all values. A value that is not determined on its interval is replaced by the
/// value of another solution for the multipliers. This value comes from a table with the same rows
/// and columns.
///
/// # Errors
/// [`TableError::Write`]: reading or writing failed.
pub fn write_chosen(
    all: impl BufRead,
    chosen: impl BufRead,
    out: impl Write,
    columns: &[ReactionColumn],
    stretches: &Stretches,
) -> Result<(), TableError> {
    let copied = copy(all, Some(chosen), out, columns, stretches);
    copied.map(|_| ()).map_err(|source| TableError::Write {
        table: "choice.csv",
        source,
    })
}

/// Copies a table. A cell that is not determined is copied from the other table; without another
/// table, the cell is empty. Returns whether a cell is not determined.
fn copy(
    mut all: impl BufRead,
    mut chosen: Option<impl BufRead>,
    out: impl Write,
    columns: &[ReactionColumn],
    stretches: &Stretches,
) -> io::Result<bool> {
    let mut out = io::BufWriter::new(out);
    let tracks: Vec<Option<&VerdictTrack>> = columns
        .iter()
        .map(|c| c.quantity.verdicts(stretches))
        .collect();
    let (mut line, mut other) = (String::new(), String::new());
    let mut has_open = false;
    let mut is_header = true;
    loop {
        line.clear();
        other.clear();
        if let Some(chosen) = &mut chosen {
            chosen.read_line(&mut other)?;
        }
        if all.read_line(&mut line)? == 0 {
            out.flush()?;
            return Ok(has_open);
        }
        if std::mem::take(&mut is_header) {
            out.write_all(line.as_bytes())?;
            continue;
        }
        let mut cells = line.trim_end_matches('\n').split(',');
        let mut others = other.trim_end_matches('\n').split(',').skip(1);
        let time = cells.next().unwrap_or_default();
        out.write_all(time.as_bytes())?;
        let t: f64 = time.parse().unwrap_or(f64::NAN);
        for (cell, track) in cells.zip(&tracks) {
            let other = others.next().unwrap_or_default();
            let is_determined = track.is_none_or(|track| track.at(t).is_unique());
            has_open |= !is_determined;
            out.write_all(b",")?;
            out.write_all(if is_determined { cell } else { other }.as_bytes())?;
        }
        out.write_all(b"\n")?;
    }
}
