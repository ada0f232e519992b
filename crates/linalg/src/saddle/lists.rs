//! Lists of indices and of values, stored one after the other.

/// Lists of indices; list k is at `start[k]..start[k + 1]`.
#[derive(Debug, Clone)]
pub(super) struct Lists {
    start: Vec<usize>,
    index: Vec<u32>,
}

impl Lists {
    pub(super) fn with_capacity(lists: usize, indices: usize) -> Self {
        let mut start = Vec::with_capacity(lists + 1);
        start.push(0);
        Self {
            start,
            index: Vec::with_capacity(indices),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.start.len() - 1
    }

    pub(super) fn clear(&mut self) {
        self.start.truncate(1);
        self.index.clear();
    }

    pub(super) fn push(&mut self, list: impl IntoIterator<Item = u32>) {
        self.index.extend(list);
        self.start.push(self.index.len());
    }

    pub(super) fn of(&self, k: usize) -> &[u32] {
        &self.index[self.start[k]..self.start[k + 1]]
    }
}

/// An entry of a matrix: its position in a row or column, and its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) index: u32,
    /// For an entry of U, the pivot coordinate of the row with position `index`.
    at: u32,
    pub(super) value: f64,
}

impl Entry {
    pub(super) fn new(index: usize, value: f64) -> Self {
        Self {
            index: index as u32,
            at: 0,
            value,
        }
    }

    /// Creates an entry of U from the position of the eliminating row, and its coordinate.
    pub(super) fn of_row(index: usize, at: usize, value: f64) -> Self {
        Self {
            at: at as u32,
            ..Self::new(index, value)
        }
    }

    /// Returns the coordinate of an entry of U.
    #[inline(always)]
    pub(super) fn at(&self) -> usize {
        self.at as usize
    }

    #[inline(always)]
    pub(super) fn index(&self) -> usize {
        self.index as usize
    }
}

/// Lists of entries; list k is at `start[k]..start[k + 1]`.
#[derive(Debug, Clone)]
pub(super) struct Entries {
    start: Vec<usize>,
    entries: Vec<Entry>,
}

impl Entries {
    pub(super) fn with_capacity(lists: usize, entries: usize) -> Self {
        let mut start = Vec::with_capacity(lists + 1);
        start.push(0);
        Self {
            start,
            entries: Vec::with_capacity(entries),
        }
    }

    #[cfg(test)]
    pub(super) fn n_entries(&self) -> usize {
        self.entries.len()
    }

    pub(super) fn push(&mut self, list: impl IntoIterator<Item = Entry>) {
        self.entries.extend(list);
        self.start.push(self.entries.len());
    }

    /// Keeps only the first `lists` lists.
    pub(super) fn truncate(&mut self, lists: usize) {
        self.start.truncate(lists + 1);
        self.entries.truncate(self.start[self.start.len() - 1]);
    }

    #[inline(always)]
    pub(super) fn of(&self, k: usize) -> &[Entry] {
        &self.entries[self.start[k]..self.start[k + 1]]
    }

    #[inline(always)]
    pub(super) fn of_mut(&mut self, k: usize) -> &mut [Entry] {
        &mut self.entries[self.start[k]..self.start[k + 1]]
    }
}
