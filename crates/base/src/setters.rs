/// Defines builder methods: one for each named field, which accepts everything that converts into its type.
#[doc(hidden)]
#[macro_export]
macro_rules! __setters {
    ($($field:ident: $type:ty),+ $(,)?) => { $(
        #[doc = concat!("The same options with another [`", stringify!($field), "`](#structfield.", stringify!($field), ").")]
        #[must_use]
        pub fn $field(self, $field: impl Into<$type>) -> Self {
            Self { $field: $field.into(), ..self }
        }
    )+ };
}

#[doc(inline)]
pub use __setters as setters;
