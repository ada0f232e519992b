//! Curves of a report beyond the reactions of single joints: sums of reactions, and the plots that
//! `[output]` requests. A curve has the name of its column in the tables of the run.

use dynamics::{MotionFault, Sample};
use model::{Loads, Mechanism, Reaction, System};
use report::{
    Quantity, ReactionColumn, Trajectory, columns_of_reactions, load_columns, load_numbers,
    numbers_of_columns,
};
use scene::{Output, PlotRequest, Scene, WantedReactions, nearest};
use solvability::{Group, GroupNumbers, Stretches};

use crate::bounds_of_run::FoundBounds;
use crate::configuration::requests;
use crate::error::StudyError;
use crate::page::{Plot, PlotCurve};
use crate::rows::RowFault;
use crate::tables_of_run::{group_numbers, more_columns, selection};

/// The origin of the values of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    /// A column of `reactions.csv`.
    Reaction(usize),
    /// A column of `loads.csv`.
    Load(usize),
    /// A column of `trajectory.csv`.
    Trajectory(usize),
}

/// A column of a table of the run.
struct TableColumn {
    name: String,
    unit: &'static str,
    source: Source,
}

/// A plot whose curves exist.
struct PlotColumns {
    title: Option<String>,
    unit: &'static str,
    curves: Vec<(String, Source)>,
}

/// Computes the values of the curves at the rows of a report.
pub(crate) struct PlotRecorder<'m> {
    mechanism: &'m Mechanism,
    columns: Vec<ReactionColumn>,
    groups: GroupNumbers<'m>,
    /// Work space for curves of loads, if there are any.
    loads: Option<Loads<'m>>,
    /// Work space for curves of the trajectory, if there are any.
    trajectory: Option<Trajectory<'m>>,
    plots: Vec<PlotColumns>,
    /// For each row, the values of all columns of groups, followed by the values of all curves of
    /// all plots.
    rows: Vec<Vec<f64>>,
}

/// Returns the trajectory whose columns can be plotted.
fn trajectory<'m>(mechanism: &'m Mechanism, output: &Output) -> Trajectory<'m> {
    let mut more = more_columns(output);
    // Without the table of the trajectory, a run computes no accelerations at its rows.
    more.accelerations &= output.trajectory;
    Trajectory::new(mechanism, more)
}

/// Returns the columns of `reactions.csv`, and the groups. Without this table, the list of columns
/// is empty.
fn columns_of(
    scene: &Scene,
    mechanism: &Mechanism,
) -> Result<(Vec<ReactionColumn>, Vec<Group>), StudyError> {
    let Some(selection) = selection(&scene.output.reactions) else {
        return Ok((Vec::new(), Vec::new()));
    };
    let groups = requests::groups(scene, mechanism, &[])?;
    let columns = columns_of_reactions(mechanism, &selection, &groups, |_| false)?;
    let groups = groups.into_iter().map(|(_, group)| group);
    Ok((columns, groups.collect()))
}

/// Returns all columns of the tables. `reactions` contains the columns of `reactions.csv`.
fn table_columns(
    mechanism: &Mechanism,
    output: &Output,
    reactions: &[ReactionColumn],
) -> Vec<TableColumn> {
    let trajectory = trajectory(mechanism, output);
    let of_reactions = reactions.iter().enumerate().map(|(k, own)| TableColumn {
        name: own.plain_name(),
        unit: own.column.unit,
        source: Source::Reaction(k),
    });
    let (space, loads) = (mechanism.space(), mechanism.loads());
    let of_loads = loads
        .forces()
        .flat_map(|(name, of)| load_columns(space, name, of));
    let of_loads = of_loads.enumerate().map(|(k, own)| TableColumn {
        name: own.to_string(),
        unit: own.unit,
        source: Source::Load(k),
    });
    let of_motion = trajectory.columns().iter().enumerate();
    let of_motion = of_motion.map(|(k, own)| TableColumn {
        name: own.to_string(),
        unit: own.unit,
        source: Source::Trajectory(k),
    });
    of_reactions.chain(of_loads).chain(of_motion).collect()
}

/// Finds the columns of the plots that a scene requests.
///
/// # Errors
/// [`StudyError::Plots`]: a column does not exist, or the curves of a plot have different units.
fn resolved(
    mechanism: &Mechanism,
    scene: &Scene,
    reactions: &[ReactionColumn],
) -> Result<Vec<PlotColumns>, StudyError> {
    let output = &scene.output;
    if output.plots.is_empty() {
        return Ok(Vec::new());
    }
    let known = table_columns(mechanism, output, reactions);
    let find = |name: &String| {
        let found = known.iter().find(|column| column.name == *name);
        found.ok_or_else(|| StudyError::Plots(unknown(name, &known, scene)))
    };
    let plot = |request: &PlotRequest| {
        let own = request.curves.iter().map(find);
        let own: Vec<&TableColumn> = own.collect::<Result<_, _>>()?;
        let unit = own.first().map_or("", |first| first.unit);
        if let Some(other) = own.iter().find(|column| column.unit != unit) {
            let [first, second] = [own[0], other].map(|column| match column.unit {
                "" => format!("`{}` has no unit", column.name),
                unit => format!("`{}` is in {unit}", column.name),
            });
            return Err(StudyError::Plots(format!(
                "{first}, {second}: all curves of a plot have one unit; write a plot for each unit"
            )));
        }
        let curves = own
            .iter()
            .map(|column| (column.name.clone(), column.source));
        Ok(PlotColumns {
            title: request.title.clone(),
            unit,
            curves: curves.collect(),
        })
    };
    output.plots.iter().map(plot).collect()
}

/// Describes a name that is not a column.
fn unknown(name: &str, known: &[TableColumn], scene: &Scene) -> String {
    let columns = || known.iter().map(|column| column.name.as_str());
    let owner = name.rsplit_once('.').map_or(name, |(owner, _)| owner);
    let own = columns().filter(|column| column.starts_with(&format!("{name}.")));
    let own: Vec<&str> = own.collect();
    let advice = if scene.inactive.iter().any(|part| part.name == owner) {
        format!("`{owner}` is not active")
    } else if !own.is_empty() {
        format!("there are {}", own.join(", "))
    } else if let Some(near) = nearest(name, columns()) {
        format!("did you mean `{near}`?")
    } else if scene.output.reactions == WantedReactions::None {
        "`reactions` is false".to_owned()
    } else {
        "write a column of reactions.csv, loads.csv or trajectory.csv, such as `A.Fx`".to_owned()
    };
    format!("there is no column `{name}`: {advice}")
}

/// Checks the plots that a scene requests, without a run.
///
/// # Errors
/// Returns the errors of [`resolved`].
pub(crate) fn check(scene: &Scene, mechanism: &Mechanism) -> Result<(), StudyError> {
    let (columns, _) = columns_of(scene, mechanism)?;
    resolved(mechanism, scene, &columns).map(|_| ())
}

impl<'m> PlotRecorder<'m> {
    /// Creates a recorder for a mechanism that starts at the coordinates q.
    ///
    /// # Errors
    /// Returns the errors of [`resolved`].
    pub(crate) fn new(
        scene: &Scene,
        mechanism: &'m Mechanism,
        q: &[f64],
    ) -> Result<Self, StudyError> {
        let (columns, groups) = columns_of(scene, mechanism)?;
        let plots = resolved(mechanism, scene, &columns)?;
        let sources = || plots.iter().flat_map(|plot| &plot.curves);
        let is_plotted = |is: fn(&Source) -> bool| sources().any(|(_, source)| is(source));
        let of_motion = is_plotted(|source| matches!(source, Source::Trajectory(_)));
        let of_loads = is_plotted(|source| matches!(source, Source::Load(_)));
        Ok(Self {
            mechanism,
            groups: GroupNumbers::new(mechanism, q, &groups),
            trajectory: of_motion.then(|| trajectory(mechanism, &scene.output)),
            loads: of_loads.then(|| mechanism.loads()),
            plots,
            columns,
            rows: Vec::new(),
        })
    }

    /// Computes the values at a row. `reactions` contains the reactions of all joints and drives.
    pub(crate) fn row(
        &mut self,
        sample: &mut Sample<'_, '_>,
        reactions: &[Reaction],
    ) -> Result<(), RowFault> {
        let of_groups = group_numbers(&mut self.groups, sample)?;
        let (space, of_groups) = (self.mechanism.space(), of_groups.as_chosen());
        let of_reactions = numbers_of_columns(&self.columns, space, reactions, of_groups);
        let of_reactions: Vec<f64> = of_reactions.collect();
        let (mut of_motion, mut of_loads) = (Vec::new(), Vec::new());
        let a = self.acceleration(sample)?;
        if let Some(trajectory) = &mut self.trajectory {
            let state = (sample.q, sample.v);
            trajectory.extend(&mut of_motion, sample.t, state, a.as_deref());
        }
        if let Some(loads) = &mut self.loads {
            let t = self.mechanism.layout().before_break(sample.t);
            let loads = loads.at(t, sample.q, sample.v);
            of_loads.extend(loads.iter().flat_map(|load| load_numbers(space, load)));
        }
        let curves = self.plots.iter().flat_map(|plot| &plot.curves);
        let plotted = curves.map(|(_, source)| match *source {
            Source::Reaction(k) => of_reactions[k],
            Source::Load(k) => of_loads[k],
            Source::Trajectory(k) => of_motion[k],
        });
        self.rows
            .push(of_groups.iter().copied().chain(plotted).collect());
        Ok(())
    }

    fn acceleration(&self, sample: &mut Sample<'_, '_>) -> Result<Option<Vec<f64>>, MotionFault> {
        let trajectory = self.trajectory.as_ref();
        let is_wanted = trajectory.is_some_and(Trajectory::has_accelerations);
        is_wanted.then(|| sample.acceleration()).transpose()
    }

    /// Returns the curve with this index in the rows. The curve of a reaction has a verdict. Values
    /// that the model does not determine are NaN.
    fn curve(
        &self,
        (at, name): (usize, String),
        of: Option<(&ReactionColumn, &Stretches)>,
        times: &[f64],
    ) -> PlotCurve {
        let values = self.rows.iter().zip(times).map(|(row, t)| match of {
            None => row[at],
            Some((column, stretches)) => {
                let value = column.quantity.value(stretches, *t, row[at]);
                value.determined().unwrap_or(f64::NAN)
            }
        });
        let track = of.and_then(|(column, stretches)| column.quantity.verdicts(stretches));
        PlotCurve {
            name,
            verdict: track.map_or("unique", |track| track.of_run().word()),
            values: values.collect(),
            band: None,
        }
    }

    /// Returns the curves of sums of reactions, each with its unit.
    pub(crate) fn groups(
        &self,
        stretches: Option<&Stretches>,
        bounds: Option<(&[ReactionColumn], &FoundBounds)>,
        times: &[f64],
    ) -> Vec<Plot> {
        let columns = self.columns.iter().filter(|column| is_of_group(column));
        let curves = columns.enumerate().filter_map(|(at, column)| {
            let stretches = stretches?;
            let of = Some((column, stretches));
            let mut curve = self.curve((at, column.plain_name()), of, times);
            curve.band = bounds.and_then(|(all, found)| {
                let k = all
                    .iter()
                    .position(|other| other.quantity == column.quantity)?;
                column.quantity.open(stretches)?;
                Some(found.ends(k, times))
            });
            Some(Plot {
                title: curve.name.clone(),
                unit: column.column.unit,
                curves: vec![curve],
            })
        });
        curves.collect()
    }

    /// Returns the requested plots.
    pub(crate) fn plots(&self, stretches: Option<&Stretches>, times: &[f64]) -> Vec<Plot> {
        let groups = self.columns.iter();
        let mut at = groups.filter(|column| is_of_group(column)).count();
        let plot = |plot: &PlotColumns| {
            let curves = plot.curves.iter().map(|(name, source)| {
                let column = match *source {
                    Source::Reaction(k) => self.columns.get(k).zip(stretches),
                    Source::Load(_) | Source::Trajectory(_) => None,
                };
                at += 1;
                self.curve((at - 1, name.clone()), column, times)
            });
            let curves: Vec<PlotCurve> = curves.collect();
            let names: Vec<&str> = curves.iter().map(|curve| curve.name.as_str()).collect();
            Plot {
                title: plot.title.clone().unwrap_or_else(|| names.join(", ")),
                unit: plot.unit,
                curves,
            }
        };
        self.plots.iter().map(plot).collect()
    }
}

fn is_of_group(column: &ReactionColumn) -> bool {
    matches!(column.quantity, Quantity::Group(..))
}
