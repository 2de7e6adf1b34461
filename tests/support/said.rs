//! What a program did and said.

use std::process::{Command, Output};

#[derive(Debug)]
pub struct Said {
    /// None if a signal ended it.
    pub status: Option<i32>,
    pub out: String,
    pub err: String,
}

impl From<Output> for Said {
    fn from(output: Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Self { status: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
    }
}

impl Said {
    /// Runs a command to its end.
    #[track_caller]
    pub fn by(command: &mut Command) -> Self {
        command.output().unwrap_or_else(|error| panic!("{command:?}: {error}")).into()
    }

    /// That a mistake was refused: status 2 and one line, which contains this.
    #[track_caller]
    pub fn is_refused(&self, expected: &str) {
        assert_eq!((self.status, self.err.lines().count(), &*self.out), (Some(2), 1, ""), "{self:?}");
        assert!(self.err.contains(expected), "{:?} lacks {expected:?}", self.err);
    }
}
