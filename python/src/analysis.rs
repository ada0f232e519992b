//! One configuration with its verdicts, and the questions that it answers.

use std::sync::Arc;

use pfaff::ConfigurationAnalysis;
use pfaff::configuration::KeptAnalysis;
use pfaff::model::System as _;
use pfaff::rank::Limits;
use pfaff::refusal::{Refusal, json};
use pfaff::report::AnalysisDocument;
use pfaff::report::documents::{
    DistributionDocument, EliminationsDocument, MakeUniqueDocument, part_as_json,
};
use pfaff::start::Judged;
use pyo3::prelude::*;
use serde::Serialize;

use crate::fault::{Fault, wrong};
use crate::hearing::heard;
use crate::options::{About, Allow, Choose};

/// An analysed configuration. All answers are documents as JSON.
#[pyclass(frozen, module = "pfaff._pfaff")]
pub(crate) struct Analysis(Arc<Configured>);

/// A scene, and the analysis of one of its configurations.
pub(crate) struct Configured {
    pub(crate) of: Arc<Judged>,
    pub(crate) kept: KeptAnalysis,
}

impl Analysis {
    pub(crate) fn new(of: Configured) -> Self {
        Self(Arc::new(of))
    }

    fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        question: impl FnOnce(&Judged, &ConfigurationAnalysis<'_>) -> Result<T, Fault> + Send + 'static,
    ) -> PyResult<T> {
        let own = Arc::clone(&self.0);
        heard(py, move |_| {
            let (scene, mechanism) = own.of.parts();
            question(
                &own.of,
                &ConfigurationAnalysis::again(scene, mechanism, &own.kept),
            )
        })
    }
}

#[pymethods]
impl Analysis {
    /// The document that `pfaff analyze --json` writes.
    fn document(&self, py: Python<'_>, combine: Vec<String>) -> PyResult<String> {
        self.ask(py, move |of, configuration| {
            let mut document = configuration.document(&combine)?;
            of.add_warnings(&mut document).map_err(Fault::from)?;
            Ok(json(&document)?)
        })
    }

    /// Name and verdict word of each joint and drive.
    fn words(&self) -> Vec<(String, &'static str)> {
        let reactions = self.0.kept.analysis.reactions.iter();
        let word =
            |r: &pfaff::solvability::ReactionVerdict| (r.name.clone(), r.wrench.verdict.word());
        reactions.map(word).collect()
    }

    /// Rank, redundancy and mobility.
    fn ranks(&self) -> (usize, usize, usize) {
        let analysis = &self.0.kept.analysis;
        let decision = &analysis.decision;
        (decision.rank, decision.redundancy, analysis.mobility())
    }

    /// The verdict on a sum of reactions, with its numbers if they are unique.
    fn combine(&self, py: Python<'_>, sum: String) -> PyResult<String> {
        self.ask(py, move |_, configuration| {
            let document = configuration.group_document(&sum)?;
            plain(&document)
        })
    }

    /// The verdict on the moment of a reaction about a point.
    fn moment(&self, py: Python<'_>, name: String, about: About) -> PyResult<String> {
        self.ask(py, move |_, configuration| {
            let id = configuration.reaction(&name)?;
            let point = about.point(configuration)?;
            let mut document = AnalysisDocument::new(&name, &configuration.analysis, None);
            let added = configuration.add_moments(&mut document, [id], point);
            added.map_err(Fault::from)?;
            plain(&document.reactions[id.0].moment)
        })
    }

    /// The smallest deletions that make a reaction unique.
    fn make_unique(&self, py: Python<'_>, name: String, allow: Allow) -> PyResult<String> {
        self.ask(py, move |_, configuration| {
            let id = configuration.reaction(&name)?;
            let allowed = allow.allowed(configuration.mechanism)?;
            let found = configuration.make_unique(id, &allowed, Limits::default());
            plain(&MakeUniqueDocument::new(&name, &allowed, found))
        })
    }

    /// The number of sets of rows that can be eliminated, and the first of them.
    fn eliminations(&self, py: Python<'_>, limit: usize) -> PyResult<String> {
        self.ask(py, move |_, configuration| {
            let sets = configuration.elimination_sets(limit);
            let count = configuration.eliminations();
            plain(&EliminationsDocument::new(count, Some(sets)))
        })
    }

    /// The reactions for a choice.
    fn distribution(&self, py: Python<'_>, choose: Choose) -> PyResult<String> {
        self.ask(py, move |_, configuration| {
            let choice = choose.choice(&|name| configuration.reaction(name))?;
            let distribution = configuration.distribution(&choice)?;
            plain(&DistributionDocument::new(&distribution, &[]))
        })
    }

    /// Refuses the name of a joint or drive that does not exist, with the nearest one.
    fn check_name(&self, py: Python<'_>, name: String) -> PyResult<()> {
        self.ask(py, move |_, configuration| {
            configuration.reaction(&name)?;
            Ok(())
        })
    }

    /// The verdicts along the motion.
    fn along(&self, py: Python<'_>, t_end: Option<f64>) -> PyResult<String> {
        let own = Arc::clone(&self.0);
        heard(py, move |hearing| {
            if let Some(t_end) = t_end
                && !(t_end.is_finite() && t_end > 0.0)
            {
                return Err(wrong(format!("t_end is {t_end}, need a time > 0")));
            }
            let study = own.of.study()?;
            let ends = || hearing.has_ended();
            let along = study.verdicts_along_motion_until(t_end, &ends, |_| {})?;
            plain(&along.document(study.prepared.mechanism.layout()))
        })
    }

    /// Coordinates and velocities; these are empty if none are known.
    fn state(&self) -> (Vec<f64>, Vec<f64>) {
        let state = &self.0.kept.state;
        (state.q.clone(), state.v.clone())
    }
}

/// A part of a document.
pub(crate) fn plain(document: &impl Serialize) -> Result<String, Fault> {
    part_as_json(document).map_err(|e| Refusal::stopped(e.to_string()).into())
}
