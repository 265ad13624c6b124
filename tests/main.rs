//! The tests of the whole: models against plain recurrences, engines against each other, waves against a second
//! reader, and the command line as its users meet it.

mod house;
mod models;
mod reference;
