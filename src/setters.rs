/// Builder methods: one for each field named, which takes what converts into its type.
macro_rules! setters {
    ($($field:ident: $type:ty),+ $(,)?) => { $(
        #[doc = concat!("The same options with another [`", stringify!($field), "`](#structfield.", stringify!($field), ").")]
        #[must_use]
        pub fn $field(self, $field: impl Into<$type>) -> Self {
            Self { $field: $field.into(), ..self }
        }
    )+ };
}

pub(crate) use setters;
