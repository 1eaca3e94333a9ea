//! Tests of the encounter sources on the campaign files of the repository.

#[cfg(test)]
mod bad_input;
#[cfg(test)]
mod common;
#[cfg(test)]
mod dnv_files;
mod intents;
#[cfg(test)]
mod law;
#[cfg(test)]
mod named_sets;
#[cfg(test)]
mod promise;
#[cfg(test)]
mod rate;
#[cfg(test)]
mod traffic;
mod worlds;
