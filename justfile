# What is done often. `just` lists it; every recipe is also a plain command.

_default:
    @just --list

# Compile and look at the code, no test
quick:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets -- -D warnings

# Everything that a change needs
test:
    cargo test

# Exhaustive and 10,000-case tests too
exhaustive:
    cargo test --release --test main -- --include-ignored

# All that must hold before a change lands
ci:
    .ci/run

# Speed next to other simulators; .ci/bench-tools installs them
bench *SECTIONS:
    cargo bench --bench peers -- {{SECTIONS}}

# Record new golden cases of waves/cases.toml
record *CASES:
    cargo run -- golden record waves {{CASES}}

# The documentation of all crates
doc:
    cargo doc --workspace --no-deps --open
