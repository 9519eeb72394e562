//! The command as a user meets it: arguments, files, output, messages and exit codes.

mod bad_corpus;
mod bad_input;
mod certify;
mod check_list;
mod command;
mod compare;
mod divergence;
mod eval_model;
mod guide;
mod hostile;
mod import_scenario;
mod interrupt;
mod logs;
mod margins;
mod outside;
mod pinocchio;
mod pipes;
mod public_robots;
mod pypi;
mod reproduce;
mod run;
mod set;
mod shell;
mod sixteen;
mod urdf;
mod verify;
