//! The command line as a user meets it: the program is started, and its files, output and exit code are judged.

mod bad_files;
mod bad_text;
mod bench;
mod films;
mod messages;
mod panels;
mod parity;
mod pictures;
mod render;
mod root;
mod signals;
mod strict;
mod support;
mod team;
mod verify;
mod view;
