//! Why a call was not carried out, in words a user can act on.

use core::fmt;

/// A refused or failed call.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    kind: Kind,
    message: String,
}

/// How the master should take it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The call was refused or failed.
    Error,
    /// The information asked for does not exist; everything goes on.
    Discard,
}

impl Error {
    /// An error with a complete sentence.
    pub fn new(message: impl Into<String>) -> Error {
        Error {
            kind: Kind::Error,
            message: message.into(),
        }
    }

    /// Information that does not exist.
    pub fn discard(message: impl Into<String>) -> Error {
        Error {
            kind: Kind::Discard,
            message: message.into(),
        }
    }

    /// How the master should take it.
    pub fn kind(&self) -> Kind {
        self.kind
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
