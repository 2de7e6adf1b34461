//! Word what a user may say of a file as the front end has it: an option of the command line, or an argument in Python.

/// Where a user says it. Messages name what helps as it is called there.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FrontEnd {
    /// `--leave-out 2`
    #[default]
    CommandLine,
    /// `leave_out=[2]`
    Python,
}

impl FrontEnd {
    /// The first on the command line, the second in Python.
    pub fn either(self, [option, argument]: [&str; 2]) -> &str {
        match self {
            Self::CommandLine => option,
            Self::Python => argument,
        }
    }

    /// What the command line calls `name`, without its value.
    pub fn name(self, name: &str) -> String {
        match self {
            Self::CommandLine => format!("--{name}"),
            Self::Python => name.replace('-', "_"),
        }
    }

    /// The same with its value, as either has it.
    pub fn choice(self, name: &str, value: [&str; 2]) -> String {
        format!("{}{}{}", self.name(name), self.either([" ", "="]), self.either(value))
    }
}
