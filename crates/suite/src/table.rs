//! Reads reference values from text: `# source`, `trusted KIND BOUND`, `t TIME`, then
//! `OWNER.QUANTITY VALUE` until the next time.

use crate::reference::{Fact, Instant, Kind, Quantity, Reference, Trust};

/// Reads a table.
///
/// # Panics
/// Panics if a line has none of these forms. The tables are part of this crate.
pub(crate) fn read(text: &str) -> Reference {
    let mut reference = Reference {
        source: String::new(),
        trust: Trust::NOTHING,
        instants: Vec::new(),
    };
    for line in text.lines().filter(|line| !line.is_empty()) {
        assert!(
            add(line, &mut reference).is_some(),
            "not a line of a reference: `{line}`"
        );
    }
    reference
}

fn add(line: &str, reference: &mut Reference) -> Option<()> {
    if let Some(source) = line.strip_prefix("# ") {
        if !reference.source.is_empty() {
            reference.source.push(' ');
        }
        reference.source.push_str(source);
        return Some(());
    }
    if let Some(trusted) = line.strip_prefix("trusted ") {
        let (name, bound) = trusted.split_once(' ')?;
        let kind = Kind::ALL.into_iter().find(|kind| kind.name() == name)?;
        *reference.trust.of_mut(kind) = bound.parse().ok()?;
        return Some(());
    }
    let (name, value) = line.split_once(' ')?;
    let value: f64 = value.parse().ok()?;
    if name == "t" {
        let facts = Vec::new();
        reference.instants.push(Instant { t: value, facts });
        return Some(());
    }
    let (of, quantity) = name.rsplit_once('.')?;
    let (quantity, _) = Quantity::NAMES
        .into_iter()
        .find(|(_, name)| *name == quantity)?;
    let of = of.to_owned();
    let instant = reference.instants.last_mut()?;
    instant.facts.push(Fact {
        of,
        quantity,
        value,
    });
    Some(())
}
