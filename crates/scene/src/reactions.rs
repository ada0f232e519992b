//! `[[group]]` and `[output]`: the requested reactions, and the requested combinations of
//! reactions.

use std::collections::HashMap;
use std::ops::Range;

use joints::Space3;
use joints::spec::ConstraintSpec;
use model::{BodyRef, SpaceKind};

use crate::active;
use crate::body::BodyNames;
use crate::combination::{self, Combination, Reactions};
use crate::cover::Cover;
use crate::field::{Field, all};
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::simulate::{Choice, choose};
use crate::space::SceneSpace;
use crate::table::{Table, belongs};

/// A combination of reactions for which a uniqueness verdict is requested.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupRequest {
    /// Name of the group.
    pub name: String,
    /// The combined reactions.
    pub content: GroupContent,
}

/// Content of a group.
#[derive(Clone, Debug, PartialEq)]
pub enum GroupContent {
    /// The reactions of these joints and drives, analysed together.
    Members(Vec<String>),
    /// A sum of reactions.
    Combination(Combination),
}

/// Requested output. Values that are not requested are not computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// `trajectory.csv`
    pub trajectory: bool,
    /// `reactions.csv`
    pub reactions: WantedReactions,
    /// `report.html`
    pub report: bool,
    /// `bounds.csv`
    pub bounds: Option<WantedBounds>,
    /// Indices of the bodies with a table of all loads, `body_NAME.csv`.
    pub bodies: Vec<usize>,
    /// Whether `trajectory.csv` contains accelerations and the derivatives of measures.
    pub accelerations: bool,
    /// Whether `trajectory.csv` contains orientations in space as roll, pitch and yaw.
    pub rpy: bool,
    /// Units of the tables.
    pub units: OutputUnits,
    /// Style of `report.html`.
    pub print: PrintStyle,
    /// Title of `report.html`, which `[scene]` states.
    pub cover: Cover,
    /// Plots of `report.html`.
    pub plots: Vec<PlotRequest>,
}

/// Style of `report.html`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PrintStyle {
    /// All results, with their evidence.
    #[default]
    Full,
    /// A short report for readers who use the results: title, verdict, picture, determined peaks
    /// and curves, and assumptions.
    Customer,
}

impl PrintStyle {
    /// All styles.
    pub const ALL: &'static [Self] = &[Self::Full, Self::Customer];

    /// Name of the style.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Customer => "customer",
        }
    }
}

/// A plot with several curves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PlotRequest {
    /// Title; without it, the names of the curves are the title.
    pub title: Option<String>,
    /// The curves: columns of `reactions.csv`, `loads.csv` or `trajectory.csv`.
    pub curves: Vec<String>,
}

/// Units of the tables of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OutputUnits {
    /// Metres and radians; the headers contain no units.
    #[default]
    Si,
    /// The units of lengths and angles that the scene chooses; the headers contain the units.
    Scene,
}

impl OutputUnits {
    const ALL: [Self; 2] = [Self::Si, Self::Scene];

    fn name(self) -> &'static str {
        match self {
            Self::Si => "si",
            Self::Scene => "scene",
        }
    }
}

/// Requested bounds of the reactions that are not determined.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WantedBounds {
    /// Joints and drives that count as rigid.
    pub rigid: Vec<String>,
    /// The largest ratio of a compliance to its nominal value.
    pub within: Option<f64>,
    /// Nominal compliances as text, such as `A=1e-6, B=2e-6`.
    pub compliance: Option<String>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            trajectory: true,
            reactions: WantedReactions::All,
            report: true,
            bounds: None,
            bodies: Vec::new(),
            accelerations: false,
            rpy: false,
            units: OutputUnits::Si,
            print: PrintStyle::default(),
            cover: Cover::default(),
            plots: Vec::new(),
        }
    }
}

/// The reactions that are written to the output file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum WantedReactions {
    /// Reactions of all joints and drives.
    #[default]
    All,
    /// No joint or drive.
    None,
    /// The reactions of these joints and drives.
    Of(Vec<String>),
}

const MEMBERS: Key = Key::required("members", "a list of joints and drives", Takes::Texts(1))
    .doc("Joints and drives whose reactions have a common verdict");
const COMBINE: Key =
    Key::required("combine", "a combination as \"A.Fx + B.Fx\"", Takes::Text).doc(
        "A sum of components as \"W3.N + W4.N\" or of whole reactions as \"W3 + W4\", with factors where wanted",
    );

/// Keys of a group, in addition to the name. Exactly one of these keys must be given.
pub(crate) const GROUP_KEYS: [Key; 2] = [MEMBERS, COMBINE];

const TRAJECTORY: Key = Key::optional("trajectory", "true or false", Takes::Flag)
    .doc("Whether `trajectory.csv` is written")
    .or(|| Output::default().trajectory.into());
const REACTIONS: Key = Key::optional(
    "reactions",
    "true, false, or a list of joints and drives",
    Takes::Names,
)
.doc("Reactions in `reactions.csv`: all, none, or those of these joints and drives")
.or(|| true.into());
const REPORT: Key = Key::optional("report", "true or false", Takes::Flag)
    .doc("Whether `report.html` is written")
    .or(|| Output::default().report.into());

const RIGID: Key = Key::optional("rigid", "a list of joints and drives", Takes::Texts(0))
    .doc("Joints and drives that count as rigid");
const WITHIN: Key = Key::optional("within", "a number ≥ 1", Takes::Number(Interval::Any))
    .doc("The largest ratio of compliances to the nominal ones");
const COMPLIANCE: Key = Key::optional("compliance", "a list as \"A=1e-6, B=2e-6\"", Takes::Text)
    .doc("Nominal compliances (m/N; after a slash in rad/(N·m)); other joints do not give way");

/// Keys of `bounds`.
const BOUNDS_KEYS: [Key; 3] = [RIGID, WITHIN, COMPLIANCE];

const BOUNDS: Key = Key::optional(
    "bounds",
    "true, false, or a table { rigid, within, compliance }",
    Takes::FlagOr(&BOUNDS_KEYS),
)
.doc("Whether `bounds.csv` is written: bounds of the reactions that the model does not determine")
.or(|| false.into());

const BODIES: Key = Key::optional("bodies", "a list of bodies", Takes::Texts(0))
    .doc("Bodies with a table of all loads, `body_NAME.csv`, for finite elements");

const ACCELERATIONS: Key = Key::optional("accelerations", "true or false", Takes::Flag)
    .doc("Whether `trajectory.csv` contains accelerations of bodies and markers, and rates of measures")
    .or(|| Output::default().accelerations.into());
const RPY: Key = Key::optional("rpy", "true or false", Takes::Flag)
    .doc("Whether `trajectory.csv` contains the orientations of bodies, and of markers with an `orientation`, as `.roll`, `.pitch` and `.yaw` too: rotations about the fixed axes x, then y, then z; in space")
    .or(|| Output::default().rpy.into());
const UNITS: Key = Key::optional(
    "units",
    "\"si\" or \"scene\"",
    Takes::OneOf(|| OutputUnits::ALL.map(OutputUnits::name).to_vec()),
)
.doc("Units of the tables: `si`, or those that the scene chooses for lengths and angles, which the headers then contain, as in `crank.x (mm)`")
.or(|| OutputUnits::default().name().into());

const PRINT: Key = Key::optional(
    "print",
    "\"full\" or \"customer\"",
    Takes::OneOf(|| PrintStyle::ALL.iter().copied().map(PrintStyle::name).collect()),
)
.doc("Style of `report.html`: `full`, or `customer`, a short report for print with determined results and assumptions")
.or(|| PrintStyle::default().name().into());
const PLOT_TITLE: Key = Key::optional("title", "a text", Takes::Text)
    .doc("Title of the plot; without it, the names of the curves");
const CURVES: Key = Key::required("curves", "a list of names of columns", Takes::Texts(1))
    .doc("Columns of the tables of the run, as `A.Fx`, of one unit");

/// Keys of a plot.
const PLOT_KEYS: [Key; 2] = [PLOT_TITLE, CURVES];

const PLOTS: Key = Key::optional(
    "plots",
    "a list of plots, each a list of names of columns, or a table { title, curves }",
    Takes::Plots(&PLOT_KEYS),
)
.doc("Plots of `report.html` with several curves, each a column of `reactions.csv`, `loads.csv` or `trajectory.csv`");

const PRINT_STYLES: Choice<PrintStyle> = Choice {
    key: PRINT,
    available: PrintStyle::ALL,
    name: PrintStyle::name,
};

const OUTPUT_UNITS: Choice<OutputUnits> = Choice {
    key: UNITS,
    available: &OutputUnits::ALL,
    name: OutputUnits::name,
};

/// Keys of `[output]`.
pub(crate) const OUTPUT_KEYS: [Key; 10] = [
    TRAJECTORY,
    ACCELERATIONS,
    RPY,
    REACTIONS,
    REPORT,
    PRINT,
    PLOTS,
    BOUNDS,
    UNITS,
    BODIES,
];

/// Returns the components that can be requested: force and torque, even if they are identically
/// zero, and the components that the definition names.
pub(crate) fn components(space: SpaceKind, spec: &ConstraintSpec) -> Vec<&'static str> {
    let all = space.components().iter().copied();
    all.chain(spec.component).collect()
}

/// Reads one group.
pub(crate) fn group(mut table: Table, name: &str, names: &Reactions) -> Option<GroupRequest> {
    let of = table.optional(&MEMBERS);
    let combine = table.optional(&COMBINE);
    let content = match (of, combine) {
        (Some(field), None) => match members(&field, names) {
            Some(none) if none.is_empty() => {
                field.error(
                    Mistake::EmptyList,
                    ": `members` is empty",
                    "needs at least one joint or drive",
                );
                None
            }
            members => members.map(GroupContent::Members),
        },
        (None, Some(combine)) => self::combine(&combine, names).map(GroupContent::Combination),
        (Some(members), Some(combine)) => {
            let first = (members.span(), "members are given here");
            let second = (combine.span(), "and a combination here");
            table.exclusive("`members` or `combine`", [first, second]);
            None
        }
        (None, None) => {
            table.missing(
                " needs `members = [\"A\", …]` or `combine = \"A.Fx + …\"`",
                "its content is missing here",
            );
            None
        }
    };
    table.close();
    content.map(|content| GroupRequest {
        name: name.to_owned(),
        content,
    })
}

/// Reads the section `[output]`.
pub(crate) fn output<S: SceneSpace>(
    mut table: Table,
    names: &Reactions,
    bodies: &BodyNames,
) -> Output {
    let defaults = Output::default();
    let reactions = table.optional(&REACTIONS);
    let reactions = reactions.and_then(|field| match field.value.get_ref().as_bool() {
        Some(true) => Some(WantedReactions::All),
        Some(false) => Some(WantedReactions::None),
        None => members(&field, names).map(WantedReactions::Of),
    });
    let rpy = table.optional(&RPY).is_some_and(|field| {
        let is_wanted = field.boolean() == Some(true);
        if is_wanted && S::KIND != SpaceKind::Space3 {
            let message = format!(": {}", belongs("rpy = true", Space3::NAME));
            let label = "in the plane, an orientation is the column `.angle`";
            field.error(Mistake::UnknownChoice, message, label);
        }
        is_wanted
    });
    let output = Output {
        trajectory: table.flag(&TRAJECTORY).unwrap_or(defaults.trajectory),
        reactions: reactions.unwrap_or_default(),
        report: table.flag(&REPORT).unwrap_or(defaults.report),
        bounds: table
            .optional(&BOUNDS)
            .and_then(|field| bounds(&field, names)),
        bodies: table
            .optional(&BODIES)
            .map_or_else(Vec::new, |field| loaded(&field, bodies)),
        accelerations: table.flag(&ACCELERATIONS).unwrap_or_default(),
        rpy,
        units: choose(&mut table, &OUTPUT_UNITS).unwrap_or_default(),
        print: choose(&mut table, &PRINT_STYLES).unwrap_or_default(),
        plots: table
            .optional(&PLOTS)
            .and_then(|field| all(&field.items(PLOTS.expected)?, plot))
            .unwrap_or_default(),
        cover: defaults.cover,
    };
    table.close();
    output
}

/// Reads a plot: a list of names, or a table.
fn plot(field: &Field) -> Option<PlotRequest> {
    if !field.value.get_ref().is_table() {
        return Some(PlotRequest {
            title: None,
            curves: curves(
                field,
                "a list of names of columns, or a table { title, curves }",
            )?,
        });
    }
    let mut table = field.table(PLOTS.expected)?;
    let title = table.optional(&PLOT_TITLE);
    let title = title.and_then(|field| field.text(PLOT_TITLE.expected));
    let curves = table.required(&CURVES);
    let curves = curves.and_then(|field| self::curves(&field, CURVES.expected));
    table.close();
    Some(PlotRequest {
        title: title.map(str::to_owned),
        curves: curves?,
    })
}

/// Reads the names of curves, at least one; repetitions are ignored.
fn curves(field: &Field, expected: &str) -> Option<Vec<String>> {
    let items = field.items(expected)?;
    if items.is_empty() {
        let label = "needs at least one name of a column";
        field.error(Mistake::EmptyList, ": a plot has no curves", label);
        return None;
    }
    let names = all(&items, |item| item.text("the name of a column"))?;
    let mut curves: Vec<String> = Vec::new();
    for name in names {
        if !curves.iter().any(|known| known == name) {
            curves.push(name.to_owned());
        }
    }
    Some(curves)
}

/// Reads a list of bodies without the ground; repetitions are ignored.
fn loaded(field: &Field, bodies: &BodyNames) -> Vec<usize> {
    let mut all = Vec::new();
    for item in field.items(BODIES.expected).into_iter().flatten() {
        match bodies.find(&item) {
            Some(BodyRef::Body(body)) if !all.contains(&body) => all.push(body),
            Some(BodyRef::Ground) => {
                let label = "the ground has no balance of loads";
                item.error(Mistake::UnknownBody, " refers to the ground", label);
            }
            _ => {}
        }
    }
    all
}

/// Reads the requested bounds.
fn bounds(field: &Field, names: &Reactions) -> Option<WantedBounds> {
    if let Some(wanted) = field.value.get_ref().as_bool() {
        return wanted.then(WantedBounds::default);
    }
    let mut table = field.table(BOUNDS.expected)?;
    let rigid = table.optional(&RIGID);
    let compliance = table.optional(&COMPLIANCE);
    let bounds = WantedBounds {
        rigid: rigid
            .and_then(|field| members(&field, names))
            .unwrap_or_default(),
        within: table.number(&WITHIN),
        compliance: compliance
            .and_then(|field| field.text(COMPLIANCE.expected))
            .map(str::to_owned),
    };
    table.close();
    Some(bounds)
}

/// Reads a list of joints and drives without repetitions.
fn members(field: &Field, names: &Reactions) -> Option<Vec<String>> {
    let expected = if field.key == REACTIONS.name {
        REACTIONS.expected
    } else {
        MEMBERS.expected
    };
    let mut members: Vec<String> = Vec::new();
    let mut first: HashMap<&str, Range<usize>> = HashMap::new();
    let mut right = true;
    for item in field.items(expected)? {
        let Some(name) = item.text("the name of a joint or drive") else {
            right = false;
            continue;
        };
        if names.find(name).is_none() && names.is_inactive(name) {
            right = false;
            item.error_with_help(
                Mistake::Inactive,
                format!(" refers to `{name}`, which is not active"),
                "not active",
                active::HELP.to_owned(),
            );
        } else if names.find(name).is_none() {
            right = false;
            let near = field.findings.suggest(name, names.names());
            item.error_with_help(
                Mistake::UnknownJoint,
                format!(" refers to the unknown joint or drive `{name}`"),
                "no such joint or drive",
                near.map(|near| format!("did you mean `{near}`?")),
            );
        } else if let Some(first) = first.get(name) {
            right = false;
            field.findings.collision(
                Mistake::Twice,
                item.span(),
                format!("{}: `{}` names `{name}` twice", item.subject, item.key),
                "named again here",
                first.clone(),
                "first named here",
            );
        } else {
            members.push(name.to_owned());
            first.insert(name, item.span());
        }
    }
    right.then_some(members)
}

fn combine(field: &Field, names: &Reactions) -> Option<Combination> {
    let text = field.text(COMBINE.expected)?;
    combination::parse(text, names)
        .map_err(|error| {
            let span = field.part(error.span);
            field.findings.error(
                Mistake::from(&error.problem),
                span,
                format!("{}: `combine`: {}", field.subject, error.problem),
                "here",
            );
        })
        .ok()
}
