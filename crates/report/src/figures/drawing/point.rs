//! Points and curves with two components in the plane and three in space.

use model::SpaceKind;
use serde::ser::{Serialize, SerializeMap, Serializer};

use crate::channel::{Channel, FewDigits};

/// A point, given by two or three coordinates (m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Point {
    at: [f64; 3],
    count: usize,
}

impl Point {
    pub(crate) fn new(space: SpaceKind, at: [f64; 3]) -> Self {
        let count = space.n_translations();
        Self { at, count }
    }

    /// Returns the point with three coordinates. In the plane, z = 0.
    pub(crate) fn at(self) -> [f64; 3] {
        self.at
    }
}

impl Serialize for Point {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.at.iter().take(self.count).map(|x| FewDigits(*x)))
    }
}

/// Curves by their names.
#[derive(Clone, Debug)]
pub(crate) struct Curves(Vec<(&'static str, Channel)>);

impl Curves {
    /// Creates curves from the columns of a table. The columns have these names, and the table is
    /// given row by row.
    pub(crate) fn new(names: &[&'static str], rows: &[Vec<f64>]) -> Self {
        let curve = |k: usize| Channel::new(rows.iter().map(move |row| row[k]));
        let named = names.iter().enumerate();
        Self(named.map(|(k, name)| (*name, curve(k))).collect())
    }

    /// Values of up to three curves at the first frame, as a vector.
    pub(crate) fn first(&self) -> [f64; 3] {
        let mut first = [0.0; 3];
        for (value, (_, curve)) in first.iter_mut().zip(&self.0) {
            *value = curve.first();
        }
        first
    }
}

impl Serialize for Curves {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, curve) in &self.0 {
            map.serialize_entry(name, curve)?;
        }
        map.end()
    }
}
