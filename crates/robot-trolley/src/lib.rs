//! The equations of the robot with its trolley as straight-line code, for the program of this
//! package and for benchmarks.

pub mod generated;
