//! A mechanism with what is to be done with it: what a text is read into, and what a program may
//! write directly.

use dynamics::{MotionError, MotionOptions};
use model::{BuildError, Description, StartError, StartOptions};

use crate::combination::{self, Combination, CombinationError, ReactionNames, Reactions};
use crate::diagnostic::Diagnostic;
use crate::locate;
use crate::nearest::nearest;
use crate::reactions::{GroupRequest, Output, components};
use crate::source_map::SourceMap;

/// A mechanism, what is to be done with it, and where all of it stands in the file, if it was read
/// from one.
///
/// ```
/// use dynamics::MotionOptions;
/// use model::{Body, Description};
/// use scene::Scene;
///
/// // Without a file: a description, and where wanted what is to be done with it.
/// let mut free = Description::new("free body");
/// free.body(Body::new("body", 1.0, 1.0));
/// let scene = Scene { simulate: Some(MotionOptions::to(1.0)), ..free.into() };
/// assert_eq!(scene.name(), "free body");
/// assert!(scene.source.is_none());
/// ```
#[derive(Clone, Default)]
pub struct Scene {
    /// The mechanism as plain data; it has the name of the scene.
    pub description: Description,
    /// What a start may and may not do.
    pub start: StartOptions,
    /// The run, if the file asks for one.
    pub simulate: Option<MotionOptions>,
    /// What is written.
    pub output: Output,
    /// Combinations of reactions whose verdict is wanted.
    pub groups: Vec<GroupRequest>,
    /// Where everything stands; nothing where there is no text.
    pub source: Option<SourceMap>,
    /// What was read and can be used, but is probably not what was meant.
    pub warnings: Vec<Diagnostic>,
}

/// A mechanism with nothing said but itself: everything by default, and no run.
impl From<Description> for Scene {
    fn from(description: Description) -> Self {
        Self {
            description,
            ..Self::default()
        }
    }
}

impl Scene {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// Its text; nothing where there is none.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        self.source.as_ref().map(|source| source.text.text())
    }

    /// The warnings as sentences, each with its line and what to do.
    pub fn cautions(&self) -> impl Iterator<Item = String> + '_ {
        self.warnings.iter().map(|w| {
            let help = w.help.as_ref().map(|help| format!("; {help}"));
            let (line, help) = (w.primary.line, help.unwrap_or_default());
            format!("line {line}: {}{help}", w.message)
        })
    }

    /// The place of an error of [`model::Mechanism::build`], for descriptions that were changed
    /// after reading; nothing where there is no text, as with the other places.
    #[must_use]
    pub fn locate_build(&self, error: &BuildError) -> Option<Diagnostic> {
        let source = self.source.as_ref()?;
        Some(locate::build(source, &self.description, error))
    }

    /// The place of an error of [`model::start`].
    #[must_use]
    pub fn locate_start(&self, error: &StartError) -> Option<Diagnostic> {
        Some(locate::start(self.source.as_ref()?, error))
    }

    /// The place of an error of a run.
    #[must_use]
    pub fn locate_motion(&self, error: &MotionError) -> Option<Diagnostic> {
        Some(locate::motion(self.source.as_ref()?, error))
    }

    /// Reads a combination of reaction components of this scene, as the key `combine` of a group
    /// has it.
    ///
    /// # Errors
    /// If the text is no sum of terms, or names a reaction or component that the scene does not
    /// have.
    pub fn combination(&self, text: &str) -> Result<Combination, CombinationError> {
        let joints = self.description.joints.iter();
        let joints = joints.map(|j| (&j.name, j.element.spec()));
        let drives = self.description.drives.iter();
        let drives = drives.map(|x| (&x.name, x.element.spec()));
        let names = joints.chain(drives).map(|(name, spec)| ReactionNames {
            name,
            components: Some(components(spec)),
        });
        combination::parse(text, &Reactions::new(names.collect()))
    }

    /// The joint or drive whose name is nearest to a name that does not exist, if one is near.
    #[must_use]
    pub fn nearest_reaction(&self, name: &str) -> Option<&str> {
        let joints = self.description.joints.iter().map(|j| j.name.as_str());
        let drives = self.description.drives.iter().map(|d| d.name.as_str());
        nearest(name, joints.chain(drives))
    }
}

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Description {
            name,
            bodies,
            joints,
            drives,
            forces,
            ..
        } = &self.description;
        f.debug_struct("Scene")
            .field("name", name)
            .field("bodies", &bodies.len())
            .field("joints", &joints.len())
            .field("drives", &drives.len())
            .field("forces", &forces.len())
            .finish_non_exhaustive()
    }
}
