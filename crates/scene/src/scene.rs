//! A scene that has been read.

use dynamics::{MotionError, MotionOptions};
use model::{BuildError, Description, StartError, StartOptions};

use crate::combination::{self, Combination, CombinationError, ReactionNames, Reactions};
use crate::diagnostic::Diagnostic;
use crate::locate;
use crate::nearest::nearest;
use crate::reactions::{GroupRequest, Output, components};
use crate::source_map::SourceMap;

/// A mechanism, what is to be done with it, and where all of it stands in the file.
#[derive(Clone)]
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
    /// Where everything stands.
    pub source: SourceMap,
}

impl Scene {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// The place of an error of [`model::Mechanism::build`], for descriptions that were changed after reading.
    #[must_use]
    pub fn locate_build(&self, error: &BuildError) -> Diagnostic {
        locate::build(&self.source, &self.description, error)
    }

    /// The place of an error of [`model::start`].
    #[must_use]
    pub fn locate_start(&self, error: &StartError) -> Diagnostic {
        locate::start(&self.source, error)
    }

    /// The place of an error of a run.
    #[must_use]
    pub fn locate_motion(&self, error: &MotionError) -> Diagnostic {
        locate::motion(&self.source, error)
    }

    /// Reads a combination of reaction components of this scene, as the key `combine` of a group has it.
    ///
    /// # Errors
    /// If the text is no sum of terms, or names a reaction or component that the scene does not have.
    pub fn combination(&self, text: &str) -> Result<Combination, CombinationError> {
        let joints = self.description.joints.iter();
        let joints = joints.map(|j| (&j.name, j.element.element().spec()));
        let drives = self.description.drives.iter();
        let drives = drives.map(|x| (&x.name, x.element.element().spec()));
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
