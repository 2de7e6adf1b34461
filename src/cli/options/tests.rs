use super::*;
use crate::stages::baselines::ClusteringMethod;

/// The names that a settings file may give, as the error for another one lists them.
fn all_names<T: Choice>() -> Vec<String> {
    let message = serde_json::from_str::<T>("\"?\"").err().expect("? is no name").to_string();
    message.split('`').skip(3).step_by(2).map(str::to_owned).collect()
}

fn check<T: Choice>() {
    let offered: Vec<String> = T::VALUES.iter().map(|(value, _)| name(value)).collect();
    assert_eq!(offered, all_names::<T>());
}

#[test]
fn names_are_those_in_files() {
    for method in ClusteringMethod::ALL {
        assert_eq!(name(&method), method.name());
    }
    for model in Model::ALL {
        assert_eq!(name(&model), model.name());
    }
    for experiment in [Experiment::Exp1, Experiment::Exp2] {
        assert_eq!(name(&experiment), experiment.name());
    }
}

#[test]
fn every_value_of_a_setting_can_be_chosen() {
    check::<Scheme>();
    check::<MapMethod>();
    check::<MapOf>();
    check::<Sampler>();
    check::<Model>();
    check::<EdgeWeight>();
    check::<Start>();
    check::<Keep>();
    check::<Experiment>();
}
