//! `reactions.csv`: force and torque on the first body of joints and drives.

use std::io::Write;

use model::{Mechanism, Reaction, SpaceKind, System};

use super::{Column, Table, TableError};

/// The joints and drives that are written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// All reactions.
    #[default]
    All,
    /// These, in the order of the rows of C, whatever the order of the names.
    Names(Vec<String>),
}

impl Selection {
    /// Indices of the selected ones.
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

/// The columns of the joint or drive at this place, in the order of the rows of C.
///
/// # Panics
/// If there is no such place.
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
        })
        .collect()
}

/// `t`, then for each joint and drive `<name>.Fx, .Fy, .T`, in space `.Fx, .Fy, .Fz, .Tx, .Ty,
/// .Tz`, and the named component of its definition, if it has one: `.N` of a knife edge, `.drive`
/// of a drive (s, N, N·m).
///
/// Numbers of non-unique reactions depend on the choice that `summary.json` states.
pub struct ReactionTable<W: Write> {
    table: Table<W>,
    n_reactions: usize,
    /// Index of each written one, and whether it has a named component.
    selected: Vec<(usize, bool)>,
    /// One row, reused.
    values: Vec<f64>,
    space: SpaceKind,
}

impl<W: Write> ReactionTable<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// - [`TableError::UnknownReaction`]: a selected name does not exist; nothing is written.
    /// - [`TableError::Write`]: the writer failed.
    pub fn new(out: W, mechanism: &Mechanism, selection: &Selection) -> Result<Self, TableError> {
        let groups = &mechanism.layout().groups;
        let places = selection.places(mechanism)?;
        let mut header = vec!["t".to_owned()];
        for &k in &places {
            header.extend(reaction_columns(mechanism, k).iter().map(Column::to_string));
        }
        Ok(Self {
            table: Table::new("reactions.csv", out, &header)?,
            n_reactions: groups.len(),
            space: mechanism.space(),
            selected: places
                .into_iter()
                .map(|k| (k, groups[k].spec.component.is_some()))
                .collect(),
            values: Vec::with_capacity(header.len()),
        })
    }

    /// Writes the reactions at time t. `reactions` contains **all** joints and drives, in the order
    /// of their rows; the table writes the selected ones.
    ///
    /// # Errors
    /// - [`TableError::Length`]: the reactions belong to another mechanism; nothing is written.
    /// - [`TableError::Write`]: the writer failed.
    pub fn row(&mut self, t: f64, reactions: &[Reaction]) -> Result<(), TableError> {
        self.table
            .check_length(t, "reactions", reactions.len(), self.n_reactions)?;
        self.values.clear();
        self.values.push(t);
        for &(k, has_component) in &self.selected {
            let r = &reactions[k];
            self.values.extend(r.components(self.space));
            if has_component {
                self.values.push(r.component.unwrap_or(f64::NAN));
            }
        }
        self.table.row(&self.values)
    }

    /// Writes the buffer and returns the writer.
    ///
    /// # Errors
    /// - [`TableError::Write`]: the writer failed.
    pub fn finish(self) -> Result<W, TableError> {
        self.table.finish()
    }
}
