//! Verdicts along a motion.
