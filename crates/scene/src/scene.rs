//! A mechanism with the requested computations. It is read from a text, or a program creates it
//! from a description.

use dynamics::{MotionError, MotionOptions};
use model::codes::Code;
use model::{
    AnyDescription, BodySpace, BuildError, Description, MechanismDescription, SpatialDescription,
    StartError, StartOptions,
};

use crate::case::LoadCase;
use crate::combination::{self, Combination, CombinationError, ReactionNames, Reactions};
use crate::diagnostic::Diagnostic;
use crate::language::Units;
use crate::locate;
use crate::nearest::nearest;
use crate::reactions::{GroupRequest, Output, components};
use crate::source_map::{Entry, SourceMap};
use crate::stiffness::CentreOfStiffness;

/// A mechanism and the requested computations. If they were read from a file, their positions in
/// the file are also available.
///
/// ```
/// use dynamics::MotionOptions;
/// use model::{Body, Description};
/// use pfaff_scene::Scene;
///
/// // Without a file: a description, and the requested computations if any.
/// let mut free = Description::new("free body");
/// free.body(Body::new("body", 1.0, 1.0));
/// let scene = Scene { simulate: Some(MotionOptions::to(1.0)), ..free.into() };
/// assert_eq!(scene.name(), "free body");
/// assert!(scene.source.is_none());
/// ```
#[derive(Clone, Default)]
pub struct Scene {
    /// The mechanism as plain data; its name is the name of the scene.
    pub description: AnyDescription,
    /// Options for the computation of the initial state.
    pub start: StartOptions,
    /// The run, if the file requests one.
    pub simulate: Option<MotionOptions>,
    /// Requested output.
    pub output: Output,
    /// The centres of stiffness, for joints with such a point.
    pub centres: Vec<CentreOfStiffness>,
    /// Combinations of reactions for which uniqueness verdicts are requested.
    pub groups: Vec<GroupRequest>,
    /// Load cases.
    pub cases: Vec<LoadCase>,
    /// Positions in the text; `None` if there is no text.
    pub source: Option<SourceMap>,
    /// Units of bare numbers in the text.
    pub units: Units,
    /// Bare numbers in the text that are not in SI units because `units` chooses other units: the
    /// start position of each number, and the size of its unit in SI.
    pub scales: Vec<(usize, f64)>,
    /// Inactive parts of the text, which were checked but are not part of the mechanism.
    pub inactive: Vec<Inactive>,
    /// Warnings about parts of the text that are valid, but are probably not what the author
    /// intended.
    pub warnings: Vec<Diagnostic>,
}

/// An inactive part of a scene, which is read but is not part of the mechanism.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inactive {
    /// `joint`, `drive`, `force` or `group`.
    pub kind: &'static str,
    /// Name of the part.
    pub name: String,
}

impl std::fmt::Display for Inactive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} `{}`", self.kind, self.name)
    }
}

/// Creates a scene that contains only the mechanism: all other settings have default values, and no
/// run is requested.
impl From<AnyDescription> for Scene {
    fn from(description: AnyDescription) -> Self {
        Self {
            description,
            ..Self::default()
        }
    }
}

impl From<Description> for Scene {
    fn from(description: Description) -> Self {
        AnyDescription::from(description).into()
    }
}

impl From<SpatialDescription> for Scene {
    fn from(description: SpatialDescription) -> Self {
        AnyDescription::from(description).into()
    }
}

impl Scene {
    /// Name of the scene.
    #[must_use]
    pub fn name(&self) -> &str {
        self.description.name()
    }

    /// Text of the scene, if there is one.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        self.source.as_ref().map(|source| source.text.text())
    }

    /// The warnings as sentences, each with its line and advice.
    pub fn cautions(&self) -> impl Iterator<Item = String> + '_ {
        self.warnings.iter().map(Diagnostic::sentence)
    }

    /// Returns the position of an error of [`model::Mechanism::build`]. This function is useful for
    /// descriptions that were changed after reading. If there is no text, this function and the
    /// other functions for positions return `None`.
    #[must_use]
    pub fn locate_build(&self, error: &BuildError) -> Option<Diagnostic> {
        let source = self.source.as_ref()?;
        Some(locate::build(source, &self.description, error))
    }

    /// The position of an error of [`model::start`].
    #[must_use]
    pub fn locate_start(&self, error: &StartError) -> Option<Diagnostic> {
        Some(locate::start(self.source.as_ref()?, error))
    }

    /// The position of an error of a run.
    #[must_use]
    pub fn locate_motion(&self, error: &MotionError) -> Option<Diagnostic> {
        Some(locate::motion(self.source.as_ref()?, error))
    }

    /// Returns whether the author suppresses warnings with this code.
    #[must_use]
    pub fn is_silenced(&self, code: Code) -> bool {
        let source = self.source.as_ref();
        source.is_some_and(|source| source.silenced.contains(&code))
    }

    /// Creates a warning about joints that was found after the scene was read. The arguments are
    /// the code, the joints, and the message with advice.
    #[must_use]
    pub fn warning_about<'a>(
        &self,
        code: Code,
        joints: impl IntoIterator<Item = &'a str>,
        text: (&str, &str),
    ) -> Option<Diagnostic> {
        Some(locate::warning(self.source.as_ref()?, code, joints, text))
    }

    /// Parses a combination of reactions of this scene, with the syntax of the key `combine` of a
    /// group.
    ///
    /// # Errors
    /// Returns an error if the text is not a sum of terms, or refers to a reaction or component
    /// that does not exist in the scene.
    pub fn combination(&self, text: &str) -> Result<Combination, CombinationError> {
        let (d, space) = (&self.description, self.description.space());
        let names = d.joints().chain(d.drives());
        let names = names.map(|(name, spec)| ReactionNames {
            name,
            components: Some(components(space, spec)),
        });
        let inactive = self.inactive.iter().map(|x| x.name.as_str());
        combination::parse(text, &Reactions::new(names.collect()).without(inactive))
    }

    /// Removes all inactive parts; the whole scene must have been checked before.
    pub(crate) fn take_out_inactive(&mut self) {
        let Some(source) = &mut self.source else {
            return;
        };
        let inactive = &mut self.inactive;
        match &mut self.description {
            AnyDescription::Plane(d) => retain_active(d, source, inactive),
            AnyDescription::Space3(d) => retain_active(d, source, inactive),
        }
        retain("group", &mut self.groups, &mut source.groups, inactive);
    }

    /// Returns whether the text contains an inactive joint or drive with this name.
    #[must_use]
    pub fn is_inactive(&self, name: &str) -> bool {
        let mut all = self.inactive.iter();
        all.any(|x| x.name == name && matches!(x.kind, "joint" | "drive"))
    }

    /// Returns the joint or drive with the most similar name, if this name is similar enough.
    #[must_use]
    pub fn nearest_reaction(&self, name: &str) -> Option<&str> {
        let named = self.description.joints().chain(self.description.drives());
        nearest(name, named.map(|(name, _)| name))
    }
}

/// Removes the inactive parts of a mechanism.
fn retain_active<S: BodySpace>(
    d: &mut MechanismDescription<S>,
    source: &mut SourceMap,
    inactive: &mut Vec<Inactive>,
) {
    retain("joint", &mut d.joints, &mut source.joints, inactive);
    retain("drive", &mut d.drives, &mut source.drives, inactive);
    retain("force", &mut d.forces, &mut source.forces, inactive);
    let joints = &d.joints;
    let is_active = |name: &str| joints.iter().any(|joint| joint.name == name);
    d.armatures.retain(|armature| is_active(&armature.joint));
}

/// Removes the inactive items of a list, and their entries in the list of positions.
fn retain<T>(
    kind: &'static str,
    items: &mut Vec<T>,
    entries: &mut Vec<Entry>,
    inactive: &mut Vec<Inactive>,
) {
    let mut is_active = entries.iter().map(|entry| entry.is_active);
    items.retain(|_| is_active.next().unwrap_or(true));
    entries.retain(|entry| {
        if !entry.is_active {
            let name = entry.name.clone();
            inactive.push(Inactive { kind, name });
        }
        entry.is_active
    });
}

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let d = &self.description;
        f.debug_struct("Scene")
            .field("name", &d.name())
            .field("bodies", &d.bodies().len())
            .field("joints", &d.joints().count())
            .field("drives", &d.drives().count())
            .field("forces", &d.n_forces())
            .finish_non_exhaustive()
    }
}
