//! Instances belong to no thread, and do not know each other.

use std::sync::mpsc;
use std::thread;

use importers::{Host, Instance, STEP, assert_same_bits, bits};

/// Mesh force and a bearing force at every communication point, under a torque of its own.
fn series(instance: &Instance<'_>, torque: f64) -> Vec<f64> {
    instance.initialize();
    instance.accepted(instance.set(&[("stage1.drive.torque", torque)]));
    let fmu = instance.host().fmu();
    let outputs = ["mesh12.force", "stage1.b1.force_x"].map(|name| fmu.reference(name));
    let mut values = Vec::new();
    for index in 0..200 {
        instance.accepted(instance.step(f64::from(index) * STEP, STEP));
        values.extend(instance.values(&outputs));
    }
    values
}

#[test]
fn an_instance_runs_on_another_thread_than_it_was_made_on() {
    let host = Host::of("three_stage");
    let here = series(&host.instance(), 2000.0);
    // As libcosim does it, and freed on a third thread.
    let there = thread::scope(|scope| {
        let made = scope.spawn(|| host.instance()).join().expect("made");
        let run = scope
            .spawn(|| (series(&made, 2000.0), made))
            .join()
            .expect("run");
        let (values, instance) = run;
        scope.spawn(|| drop(instance)).join().expect("freed");
        values
    });
    assert_same_bits(&here, &there, 2);
}

#[test]
fn an_instance_changes_threads_while_it_runs() {
    let host = Host::of("three_stage");
    let straight = host.running();
    straight.steps(0, 20);
    let instance = host.running();
    thread::scope(|scope| {
        let mut wandering = instance;
        for index in 0..20 {
            let on_the_way = move || {
                wandering.steps(index, 1);
                wandering
            };
            wandering = scope.spawn(on_the_way).join().expect("a step");
        }
        assert_eq!(
            bits(&[wandering.value("mesh12.force")]),
            bits(&[straight.value("mesh12.force")])
        );
    });
}

#[test]
fn four_instances_on_four_threads_give_the_bits_of_one_after_the_other() {
    const TORQUES: [f64; 4] = [2250.0, 2000.0, 1000.0, -500.0];
    let host = Host::of("three_stage");
    let one_by_one = TORQUES.map(|torque| series(&host.instance(), torque));
    let at_once = thread::scope(|scope| {
        let host = &host;
        TORQUES
            .map(|torque| scope.spawn(move || series(&host.instance(), torque)))
            .map(|running| running.join().expect("a run"))
    });
    for (alone, among_others) in one_by_one.iter().zip(&at_once) {
        assert_same_bits(among_others, alone, 2);
    }
    assert_ne!(one_by_one[0], one_by_one[1], "the torque matters");
}

#[test]
fn an_error_of_one_instance_leaves_the_others_alone() {
    let host = Host::of("three_stage");
    let (undisturbed, one, other) = (host.running(), host.running(), host.running());
    undisturbed.steps(0, 10);
    for index in 0..10 {
        one.steps(index, 1);
        other.refused(other.step(-1.0, 1.0));
        other.refused(other.set(&[("mesh12.force", f64::NAN)]));
    }
    drop(other);
    assert_eq!(
        bits(&[one.value("mesh12.force")]),
        bits(&[undisturbed.value("mesh12.force")])
    );
}

#[test]
fn a_thread_may_end_after_the_library_was_unloaded() {
    // Whatever the library leaves behind for the end of a thread must still be there then.
    for _ in 0..20 {
        let (to_main, from_thread) = mpsc::channel();
        let (to_thread, from_main) = mpsc::channel();
        let user = thread::spawn(move || {
            let host = Host::of("three_stage");
            let instance = host.running();
            instance.steps(0, 3);
            instance.refused(instance.step(-1.0, STEP));
            drop(instance);
            to_main.send(host).expect("main waits");
            from_main.recv().expect("main answers");
        });
        drop(from_thread.recv().expect("the thread has run"));
        to_thread.send(()).expect("the thread waits");
        user.join().expect("the thread ends");
    }
}
