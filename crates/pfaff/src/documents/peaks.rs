//! The peaks of all loads of a run as one list.

use report::{Column, Quantity, ReactionColumn};

use super::{
    ExtremeDocument, LoadOfRunDocument, MagnitudeOfRunDocument, PeakDocument, RunDocument,
};
use crate::words::load_unit;

/// Unit of forces.
const FORCE: &str = "N";

/// Unit of moments.
const MOMENT: &str = "N·m";

/// A load with its peak during a run.
pub(crate) struct LoadPeak {
    /// Name of the joint, drive, group or force element.
    pub(crate) name: String,
    /// `force` and `moment` for the largest magnitudes, `force at most` and `moment at most` for
    /// their upper bounds, or the name of a component.
    pub(crate) load: String,
    /// Unit of the peak.
    pub(crate) unit: &'static str,
    /// The peak. `None` if the load is not determined during the whole run.
    pub(crate) peak: Option<ExtremeDocument>,
}

impl LoadPeak {
    /// Returns the peaks of all loads of a run. The reactions and groups of the run have these
    /// columns.
    pub(crate) fn all(run: &RunDocument, columns: &[ReactionColumn]) -> Vec<Self> {
        let mut all = Vec::new();
        let mut add = |name: &str, load: &str, unit, peak| {
            all.push(Self {
                name: name.to_owned(),
                load: load.to_owned(),
                unit,
                peak,
            });
        };
        let throughout = |peak: &Option<PeakDocument>| {
            let peak = peak.as_ref()?;
            let value = peak.value.determined()?;
            let is_whole = matches!(peak.over.as_slice(), [[_, to]] if *to >= run.t_end);
            is_whole.then(|| ExtremeDocument::new(value, peak.time))
        };
        for (name, reaction) in &run.reactions.0 {
            let has = |letter| {
                reaction
                    .components
                    .0
                    .iter()
                    .any(|(own, _)| own.starts_with(letter))
            };
            let peak = reaction.peak.as_ref();
            if has('F') {
                add(
                    name,
                    "force",
                    FORCE,
                    peak.and_then(|peak| throughout(&peak.force)),
                );
            }
            if has('T') {
                add(
                    name,
                    "moment",
                    MOMENT,
                    peak.and_then(|peak| throughout(&peak.moment)),
                );
            }
            let of_definition = columns.iter().find(|column| {
                let Column { owner, number, .. } = &column.column;
                matches!(column.quantity, Quantity::Component(..))
                    && owner == name
                    && load_unit(number).is_empty()
            });
            if let Some(ReactionColumn { column, .. }) = of_definition {
                let own = reaction.components.get(column.number);
                let peak = own.and_then(|own| throughout(&own.peak));
                add(name, column.number, column.unit, peak);
            }
            if let Some(MagnitudeOfRunDocument { force, moment }) = reaction.magnitude_at_most {
                add(name, "force at most", FORCE, force);
                add(name, "moment at most", MOMENT, moment);
            }
        }
        for ReactionColumn {
            column, quantity, ..
        } in columns
        {
            let (Quantity::Group(..), Some(group)) = (quantity, run.groups.get(&column.owner))
            else {
                continue;
            };
            let peak = match group.components.get(column.number) {
                Some(number) => &number.peak,
                None => &group.peak,
            };
            add(&column.owner, column.number, column.unit, throughout(peak));
        }
        // The state determines the loads of force elements. Therefore a load without a peak is
        // zero.
        let peak_of =
            |peak: Option<ExtremeDocument>| Some(peak.unwrap_or(ExtremeDocument::new(0.0, 0.0)));
        for (name, LoadOfRunDocument { peak, .. }) in &run.loads.0 {
            add(name, "force", FORCE, peak_of(peak.force));
            add(name, "moment", MOMENT, peak_of(peak.moment));
        }
        all
    }
}
