//! Several runs on one thread, one after the other. This module replaces `lanes` where there are no
//! coroutines.

use dynamics::Stop;

use super::SweepError;
use super::job::Job;
use super::run::MadeRun;

/// Performs the runs and passes on each result as soon as the result is available.
pub(super) fn together(
    jobs: Vec<Job>,
    interrupted: &Stop<'_>,
    done: &mut dyn FnMut(u64, Result<Option<MadeRun>, SweepError>) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    for job in jobs {
        done(job.run, job.go(None, interrupted))?;
    }
    Ok(())
}
