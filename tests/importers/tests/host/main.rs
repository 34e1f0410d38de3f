//! The packed example under a host that does what no master should.
//!
//! Authority: FMI 2.0.4, sections 2.1 and 4.2, and what importers are known to do. Whatever is called, whenever
//! and with whatever arguments: the answer is a status and a sentence, and the slave stays as it was.

mod absurd_numbers;
mod arguments;
mod births;
mod legality;
mod logging;
mod optional;
mod steps;
mod threads;
