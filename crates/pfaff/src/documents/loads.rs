//! Loads of force elements at one state.

use model::Mechanism;
use report::{ByName, load_columns, load_numbers};

/// The loads of the force elements, by name. The numbers of each load are given by the names of the
/// columns of `loads.csv`.
pub type LoadsDocument = ByName<ByName<f64>>;

/// Returns the loads of the force elements at time t (s), coordinates q and velocities v.
#[must_use]
pub fn loads_at(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> LoadsDocument {
    let mut loads = mechanism.loads();
    let found = loads.at(t, q, v);
    let space = mechanism.space();
    let each = loads.forces().zip(&found).map(|((name, measure), load)| {
        let columns = load_columns(space, name, measure);
        let names = columns.map(|column| column.number.to_owned());
        let numbers = names.zip(load_numbers(space, load));
        (name.to_owned(), ByName(numbers.collect()))
    });
    ByName(each.collect())
}
