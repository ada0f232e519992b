//! All results for a configuration as one document, which `pfaff analyze --json` writes.

use crate::documents::AnalysisDocument;
use crate::documents::{EliminationsDocument, GroupDocument};
use model::{SpaceKind, System};
use solvability::{ReactionVerdict, Verdict};

use super::{ConfigurationAnalysis, requests};
use crate::error::StudyError;
use crate::pulls::{PullTimes, PullWarning};

impl ConfigurationAnalysis<'_> {
    /// Returns ranks with their proof, verdicts, groups, reasons and warnings as plain data. This
    /// is the document that `pfaff analyze --json` writes, with the same keys. The groups of the
    /// scene come first, then the given combinations as in [`ConfigurationAnalysis::groups`]. Rows
    /// are counted from 1.
    ///
    /// More expensive results are computed separately and may be added to the document:
    ///
    /// ```
    /// use pfaff::prelude::*;
    ///
    /// let mut sleigh = Description::new("sleigh");
    /// let body = sleigh.body(Body::new("sleigh", 10.0, 1.0));
    /// sleigh.joint("blade", &[body], KnifeEdge { s: [0.0, 0.0], normal: Direction::Y });
    /// let study = Study::build(sleigh)?;
    /// let document = study.analyse(0.0, None)?.document(&[])?;
    /// assert_eq!((document.ranks.rank, document.ranks.mobility), (1, 2));
    /// let json = serde_json::to_value(&document).unwrap();
    /// assert_eq!(json["reactions"][0]["name"], "blade");
    /// assert_eq!(json["reactions"][0]["verdict"], "unique");
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the errors of [`ConfigurationAnalysis::groups`],
    /// [`ConfigurationAnalysis::explanation`], [`ConfigurationAnalysis::continuation`] and
    /// [`ConfigurationAnalysis::is_locked`]. Groups without numbers are reported as a warning in
    /// the document, not as an error.
    pub fn document(&self, combine: &[String]) -> Result<AnalysisDocument, StudyError> {
        let groups = self.groups(combine)?;
        let (generic, generic_verdicts) = self.generic_with_verdicts().unzip();
        let mut document =
            AnalysisDocument::new(self.scene.name(), &self.analysis, generic.as_ref())
                .with_freedoms(self.freedoms()?, self.mechanism);
        if let Some(verdicts) = generic_verdicts.flatten() {
            document.add_generic_verdicts(&verdicts);
        }
        document.groups = groups
            .iter()
            .map(|(name, verdict)| GroupDocument::new(name, verdict))
            .collect();
        if !groups.is_empty() && self.analysis.decision.is_decided() {
            match self.determined(combine) {
                Ok(numbers) => {
                    let given = document.groups.drain(..).zip(&numbers);
                    document.groups = given.map(|(g, values)| g.with_values(values)).collect();
                }
                Err(e) => document
                    .warnings
                    .push(format!("the values of sums are not available: {e}")),
            }
        }
        if let Some(explanation) = self.explanation()? {
            document.explain(&explanation, self.mechanism.layout());
            add_centres(&mut document, self)?;
        }
        if let Some(generic) = &generic {
            document.answers.continuation = self.continuation(generic)?.as_ref().map(Into::into);
        }
        let sensitivities = self.sensitivities()?;
        document.add_sensitivities(&sensitivities, self.mechanism.layout());
        let asked = requests::groups(self.scene, self.mechanism, combine)?.into_iter();
        let asked: Vec<_> = asked.map(|(_, group)| group).collect();
        let judged = groups.iter().map(|(_, verdict)| verdict);
        let pairs: Vec<_> = asked.iter().zip(judged).collect();
        let found = self.sensitivities_of_groups(&pairs, &sensitivities)?;
        let layout = self.mechanism.layout();
        let described = document.groups.iter_mut().zip(&asked);
        for ((group, asked), found) in described.zip(&found) {
            group.unit = asked.unit(layout);
            group.add_sensitivities(found, layout);
        }
        document.warnings.extend(sensitivities.left_out);
        document.warnings.extend(self.scene.cautions());
        document.add_notes(self.mechanism.layout());
        document.add_contacts(self.mechanism.layout());
        document.warnings.extend(only_here(&document, self));
        let has_drives = layout.groups.iter().any(|group| group.is_drive());
        let freedoms = &mut document.ranks.freedoms;
        // If other configurations were reached, the mechanism can move, unless the search ignored
        // drives, knife edges or similar constraints.
        if freedoms.cannot_move.is_none() && generic.is_some() && !has_drives && layout.h == 0 {
            freedoms.cannot_move = Some(false);
        }
        document.warnings.extend(locked(&document));
        let pulls = self.pulls();
        let pulling = PullWarning::new(&pulls, PullTimes::Instant);
        let pulling = pulling.map(|warning| warning.to_string());
        document.warnings.extend(pulling);
        for found in self.no_finite_reactions()? {
            document.add_no_finite(found);
        }
        document.answers.eliminations = Some(EliminationsDocument::new(self.eliminations(), None));
        Ok(document)
    }
}

/// For moments in space that are not unique about the reference points, adds the points about which
/// these moments are unique. In the plane, all points of a line of action have this property.
fn add_centres(
    document: &mut AnalysisDocument,
    configuration: &ConfigurationAnalysis<'_>,
) -> Result<(), StudyError> {
    let reactions = configuration.analysis.reactions.iter();
    let open = |r: &&ReactionVerdict| {
        r.space == SpaceKind::Space3 && r.wrench.verdict == Verdict::NotUnique
    };
    for reaction in reactions.filter(open) {
        if let Some(centre) = configuration.centre_of_moments(reaction.id)? {
            document.add_centre(reaction.id, reaction.space, centre);
        }
    }
    Ok(())
}

/// Describes the configurations with which a singular configuration was compared. The motion may
/// not reach these configurations, because the steps to them ignore the drives.
fn only_here(d: &AnalysisDocument, configuration: &ConfigurationAnalysis<'_>) -> Option<String> {
    let generic = d.generic.as_ref()?;
    if generic.redundancy >= d.ranks.redundancy || d.evidence.permanent != Some(false) {
        return None;
    }
    let layout = configuration.mechanism.layout();
    let drives = layout.groups.iter().any(|g| g.is_drive());
    let free = match (drives, d.configuration.nonholonomic_rows > 0) {
        (false, false) => "",
        (true, false) => ", with drives left free",
        (false, true) => ", with knife edges and other conditions on velocities left free",
        (true, true) => ", with drives, knife edges and other conditions on velocities left free",
    };
    let compared = match generic.points.len() {
        1 => "the compared configuration is a pose".to_owned(),
        n => format!("the {n} compared configurations are poses"),
    };
    Some(format!(
        "redundancy {} and its verdicts hold at this singular configuration only; {compared} that the joints allow{free}, and `--along` \
         shows whether the motion leaves this one",
        d.ranks.redundancy,
    ))
}

/// States in a sentence that the free velocities of first order are not motions.
fn locked(d: &AnalysisDocument) -> Option<String> {
    let freedoms = &d.ranks.freedoms;
    let at_first_order = freedoms.first_order(d.ranks.mobility)?;
    let sentence = freedoms.cannot_move_sentence(d.ranks.mobility);
    (freedoms.cannot_move == Some(true)).then(|| {
        format!(
            "{at_first_order} at first order, but {sentence}: second order blocks every velocity that the constraints allow"
        )
    })
}
