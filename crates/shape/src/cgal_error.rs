use walpha_base::advice::Advice;

/// Why CGAL gave no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CgalError {
    /// C++ was given no more memory.
    #[error("no memory for the {stage}: C++ ran out of it")]
    Memory {
        /// What was made.
        stage: &'static str,
    },
    /// CGAL threw. This is a fault of walpha or CGAL, not of the input.
    #[error("CGAL failed in the {stage} stage: {text}")]
    Thrown {
        /// The stage that asked.
        stage: &'static str,
        /// What C++ said.
        text: String,
    },
    /// This program was built without CGAL.
    #[error(
        "this walpha was built without CGAL: there is no engine cgal and no triangulation of the plane"
    )]
    Absent,
}

impl CgalError {
    /// What to do about it.
    pub fn advice(&self) -> Advice {
        match self {
            Self::Memory { .. } => "allow more, use the native engine, or select fewer points",
            Self::Thrown { .. } => "please report this with the input",
            Self::Absent => "use the native engine, or build with the feature `cgal`",
        }
        .into()
    }
}
