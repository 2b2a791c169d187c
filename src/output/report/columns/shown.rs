//! How figures and tables show a number of a run.

/// How figures and tables show a number of a run.
#[derive(Debug, Clone, Copy)]
pub(in crate::report) struct Shown {
    /// What it is called on an axis, without the unit; empty where the beginning of the column's meaning says it.
    pub title: &'static str,
    /// Its symbol; empty without one.
    pub symbol: &'static str,
    pub digits: Digits,
    /// Whether it may have both signs, and a change of the sign matters more than sizes.
    pub is_signed: bool,
    /// The column whose statistical error it is; empty if it is none.
    pub error_of: &'static str,
    /// The column whose error by the mesh it is; empty if it is none.
    pub mesh_error_of: &'static str,
}

/// The digits of a number for a reader.
#[derive(Debug, Clone, Copy)]
pub(in crate::report) struct Digits {
    /// The last digit that is shown at all.
    pub last: Last,
    /// The last digit where the mesh error is not known: the statistical error alone would promise too many.
    pub unmeasured: Last,
    /// The power of ten of a digit that is shown whatever the error is.
    pub coarsest: i32,
}

/// The last digit of a number.
#[derive(Debug, Clone, Copy)]
pub(in crate::report) enum Last {
    /// That of a power of ten: −4 is the fourth decimal.
    Place(i32),
    /// So many significant digits.
    Significant(usize),
}

impl Digits {
    /// Four significant digits.
    pub const FOUR: Self =
        Self { last: Last::Significant(4), unmeasured: Last::Significant(4), coarsest: i32::MAX };
}

impl Last {
    /// The power of ten of the last digit of `x`.
    pub fn place(self, x: f64) -> i32 {
        match self {
            Self::Place(place) => place,
            Self::Significant(digits) => x.abs().max(1.0).log10().floor() as i32 + 1 - digits as i32,
        }
    }
}

/// As the beginning of its meaning says, with four digits.
pub(super) const BY_MEANING: Shown = titled("");

/// A number of that title, with four digits.
pub(super) const fn titled(title: &'static str) -> Shown {
    Shown { title, symbol: "", digits: Digits::FOUR, is_signed: false, error_of: "", mesh_error_of: "" }
}

impl Shown {
    pub(super) const fn symbol(self, symbol: &'static str) -> Self {
        Self { symbol, ..self }
    }

    pub(super) const fn digits(self, digits: Digits) -> Self {
        Self { digits, ..self }
    }

    pub(super) const fn signed(self) -> Self {
        Self { is_signed: true, ..self }
    }

    pub(super) const fn error_of(self, error_of: &'static str) -> Self {
        Self { error_of, ..self }
    }

    pub(super) const fn mesh_error_of(self, mesh_error_of: &'static str) -> Self {
        Self { mesh_error_of, ..self }
    }
}
