//! Finds CGAL, then compiles the bridge in `cpp/` against it; nothing without the feature `cgal`.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=DOCS_RS");
    // Documentation on docs.rs is built where there is no CGAL; nor do checks link it.
    #[cfg(feature = "cgal")]
    if std::env::var_os("DOCS_RS").is_none() {
        bridge::build();
    }
}

#[cfg(feature = "cgal")]
mod bridge {
    use std::path::{Path, PathBuf};
    use std::{env, fs};

    /// The first CGAL whose `Regular_triangulation_3` and `Fixed_alpha_shape_3` the bridge is written for.
    const OLDEST: (u32, u32) = (5, 3);

    /// The files that use the macro of cxx.
    const BRIDGES: &[&str] = &[
        #[cfg(feature = "cgal-oracles")]
        "src/cgal/alpha.rs",
        "src/cgal/ffi.rs",
        #[cfg(feature = "cgal-oracles")]
        "src/cgal/periodic.rs",
        #[cfg(any(feature = "paper", feature = "cgal-oracles"))]
        "src/cgal/plane.rs",
        #[cfg(feature = "cgal-oracles")]
        "src/cgal/regular.rs",
    ];
    /// The slowest first, as the feature `cgal-oracles` compiles several at a time.
    const SOURCES: &[&str] = &[
        #[cfg(feature = "cgal-oracles")]
        "cpp/periodic.cc",
        #[cfg(feature = "cgal-oracles")]
        "cpp/alpha.cc",
        #[cfg(feature = "cgal-oracles")]
        "cpp/regular.cc",
        #[cfg(any(feature = "paper", feature = "cgal-oracles"))]
        "cpp/plane.cc",
        "cpp/shape.cc",
        "cpp/bridge.cc",
    ];
    const HEADERS: &[&str] = &[
        "cpp/alpha.h",
        "cpp/bridge.h",
        "cpp/classes.h",
        "cpp/copy.h",
        "cpp/kernel.h",
        "cpp/nearest.h",
        "cpp/periodic.h",
        "cpp/plane.h",
        "cpp/points.h",
        "cpp/regular.h",
        "cpp/shape.h",
    ];

    pub(crate) fn build() {
        for file in SOURCES.iter().chain(HEADERS).chain(BRIDGES) {
            println!("cargo::rerun-if-changed={file}");
        }
        for variable in ["CGAL_DIR", "VCPKG_ROOT", "HOMEBREW_PREFIX"] {
            println!("cargo::rerun-if-env-changed={variable}");
        }
        let cgal = match find() {
            Ok(cgal) => cgal,
            Err(why) => {
                for line in why.lines() {
                    println!("cargo::error={line}");
                }
                std::process::exit(1);
            }
        };

        let mut build = cxx_build::bridges(BRIDGES);
        build.files(SOURCES).std("c++17").opt_level(2).debug(false);
        // Interval arithmetic needs the rounding mode left alone; CGAL's assertions, which check it,
        // stay on (no NDEBUG): they cost nothing measurable. No -ffast-math, no -march, no LTO here.
        // With -pthread, CGAL keeps its caches thread-local.
        for flag in ["-frounding-math", "-ffp-contract=off", "-pthread"] {
            build.flag_if_supported(flag);
        }
        if let Some(include) = &cgal.include {
            // A system header's warnings are not ours.
            build.flag("-isystem").flag(include.to_str().expect("UTF-8 path"));
        }
        if !cgal.gmp {
            // Found or not: CGAL then computes with Boost.Multiprecision.
            build.define("CGAL_DISABLE_GMP", "1");
        }
        build.flag_if_supported("-Wall").flag_if_supported("-Wextra");
        println!("cargo::rerun-if-env-changed=WALPHA_SANITIZE");
        let sanitized = env::var_os("WALPHA_SANITIZE").is_some();
        if sanitized {
            build.flag("-fsanitize=address,undefined").flag("-fno-sanitize-recover=undefined");
            build.flag("-fno-omit-frame-pointer");
        }
        build.compile("walpha_cgal");
        if sanitized {
            println!("cargo::rustc-link-lib=asan");
            println!("cargo::rustc-link-lib=ubsan");
        }

        let prefix = cgal.include.as_ref().and_then(|include| include.parent());
        if let Some(lib) = prefix.map(|prefix| prefix.join("lib")).filter(|lib| lib.is_dir()) {
            println!("cargo::rustc-link-search=native={}", lib.display());
        }
        if cgal.gmp {
            println!("cargo::rustc-link-lib=mpfr");
            println!("cargo::rustc-link-lib=gmp");
        }
    }

    /// An installed CGAL: `include` is `None` when the compiler finds it by itself.
    struct Cgal {
        include: Option<PathBuf>,
        gmp: bool,
    }

    fn find() -> Result<Cgal, String> {
        let mut too_old = None;
        let mut tried = Vec::new();
        for include in candidates() {
            let name = match &include {
                Some(dir) => dir.display().to_string(),
                None => "the compiler's own path".to_owned(),
            };
            match probe(include.as_deref()) {
                Some((version, gmp)) if version >= OLDEST => return Ok(Cgal { include, gmp }),
                Some((version, _)) => too_old = too_old.or(Some((version, name.clone()))),
                None => {}
            }
            tried.push(name);
        }
        let found = match too_old {
            Some(((major, minor), place)) => format!("found CGAL {major}.{minor} in {place}, but"),
            None => format!("no CGAL in {}:", tried.join(", ")),
        };
        Err(format!(
            "{found} walpha needs CGAL {}.{} or later with its Boost (and GMP, MPFR), and a C++17 compiler. Install it:\n\
               Debian, Ubuntu   sudo apt-get install --no-install-recommends libcgal-dev g++\n\
               Fedora           sudo dnf install CGAL-devel gcc-c++\n\
               Arch             sudo pacman -S cgal gcc\n\
               Homebrew         brew install cgal\n\
               vcpkg            vcpkg install cgal    (and set VCPKG_ROOT)\n\
             or set CGAL_DIR to the folder that holds include/CGAL.",
            OLDEST.0, OLDEST.1
        ))
    }

    /// Include folders in the order they are tried. `CGAL_DIR` may be the prefix, its include folder,
    /// or the folder of `CGALConfig.cmake`, as `CMake` takes it.
    fn candidates() -> Vec<Option<PathBuf>> {
        let mut found = Vec::new();
        if let Some(dir) = env::var_os("CGAL_DIR").map(PathBuf::from) {
            let ancestors: Vec<_> = dir.ancestors().take(4).map(Path::to_owned).collect();
            for place in ancestors {
                found.extend([place.clone(), place.join("include")]);
            }
        }
        let mut found: Vec<_> = found.into_iter().map(Some).collect();
        found.push(None);
        let vcpkg = env::var_os("VCPKG_ROOT").map(|root| PathBuf::from(root).join("installed"));
        let triplets =
            vcpkg.and_then(|installed| fs::read_dir(installed).ok()).into_iter().flatten();
        let prefixes = env::var_os("HOMEBREW_PREFIX").map(PathBuf::from).into_iter();
        let usual =
            ["/opt/homebrew", "/usr/local", "/home/linuxbrew/.linuxbrew"].map(PathBuf::from);
        for prefix in triplets.flatten().map(|entry| entry.path()).chain(prefixes).chain(usual) {
            found.push(Some(prefix.join("include")));
        }
        found.retain(|include| {
            include.as_ref().is_none_or(|dir| dir.join("CGAL/version.h").is_file())
        });
        found
    }

    /// Preprocesses a few lines to learn the version of CGAL, and whether it is to compute with GMP.
    fn probe(include: Option<&Path>) -> Option<((u32, u32), bool)> {
        let source = PathBuf::from(env::var_os("OUT_DIR")?).join("probe.cc");
        fs::write(
            &source,
            "#include <CGAL/version.h>\n#include <boost/version.hpp>\n\
             walpha_cgal_version CGAL_VERSION_NR\n\
             #if __has_include(<gmp.h>) && __has_include(<mpfr.h>)\nwalpha_gmp 1\n#endif\n",
        )
        .ok()?;
        let mut build = cc::Build::new();
        build.cpp(true).std("c++17").cargo_metadata(false).cargo_warnings(false).file(&source);
        if let Some(include) = include {
            build.include(include);
        }
        let text = String::from_utf8(build.try_expand().ok()?).ok()?;
        // 1050501000 is 5.5.1: a leading 1, then two digits for each of major, minor and patch. The
        // preprocessor may put line markers before it.
        let after = text.split_once("walpha_cgal_version")?.1;
        let number =
            after.split_whitespace().find(|word| word.len() == 10 && word.starts_with('1'))?;
        let number: u32 = number.parse().ok()?;
        let version = (number / 10_000_000 % 100, number / 100_000 % 100);
        let gmp = text.lines().any(|line| line.starts_with("walpha_gmp"));
        Some((version, gmp && cfg!(feature = "gmp")))
    }
}
