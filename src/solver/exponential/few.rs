//! The forces at the nodes of a step where springs are few and their laws straight lines: what `equations`, `elimination` and
//! `exchange` do for any number of them, for a number that the compiler knows.
//!
//! Lists of pairs, and the order of elimination, are looked up for springs by the dozen; for two meshes that would be most of the
//! work. Here loops are unrolled, and every spring has to do with every other one.

use super::elimination::{
    Square, inverse_with_one, solved, subtract_product, subtract_times, times,
};
use super::equations::{Equations, MOST_FEEDBACK, PLACES_OF_LINES, Tangents, without_movement};
use super::exchange::Influences;
use super::lanes::{Quad, add_multiple, are_finite, subtract_multiple};
use super::nodes::{cubic_at_checks, larger};
use super::polynomials::{CHECKS, NODES};
use super::sight::{Moved, Sight, at_checks, rates_at_nodes};
use crate::solver::Lines;

/// So many springs are few: `nodes` has a case for each number of them.
pub(super) const FEW: usize = 3;

/// Prepares for [`solve`] what does not depend on how couplings move. Gives whether the step is short enough; `None` where there are not
/// M springs.
#[inline(always)]
pub(super) fn prepare<const M: usize>(
    equations: &mut Equations,
    influences: &Influences,
    sight: &mut Sight,
) -> Option<bool> {
    let lines: &[Lines<PLACES_OF_LINES>; M] = equations.lines.first_chunk()?;
    let tangents: &[Tangents; M] = equations.tangents.first_chunk()?;
    let blocks: &mut [[Square; M]; M] = equations.blocks.as_chunks_mut().0.first_chunk_mut()?;
    let moved_by = square::<_, M>(&influences.of_pairs)?;
    let rates_by = square::<_, M>(&influences.rates)?;
    let mut forces = [[0.0; 4]; M];
    for (i, forces) in forces.iter_mut().enumerate() {
        *forces = without_movement(&lines[i], sight.start(i));
    }
    let at_start = forces.map(|force| force[0]);
    let mut feedback = [0.0; 4];
    for i in 0..M {
        for j in 0..M {
            let (moved, rates) = (&moved_by[i][j], &rates_by[i][j]);
            let known = tangents[i].push(&moved[0], &rates[0]);
            subtract_multiple(&mut forces[i], at_start[j], &known);
            for (node, column) in (1..).zip(&mut blocks[i][j]) {
                *column = tangents[i].push(&moved[node], &rates[node]);
            }
        }
        for column in &blocks[i][i] {
            for (most, one) in feedback.iter_mut().zip(column) {
                *most = larger(*most, one.abs());
            }
        }
        sight.forces[i] = forces[i];
    }
    factorize(blocks);
    Some(feedback.into_iter().fold(0.0, larger) <= MOST_FEEDBACK)
}

/// Solves for the forces at the nodes, sees how couplings move under them, and how the end would change with what the cubics leave
/// out. Gives whether the forces are numbers; `None` where there are not M springs.
#[inline(always)]
pub(super) fn solve<const M: usize>(
    equations: &Equations,
    influences: &Influences,
    step: f64,
    sight: &mut Sight,
) -> Option<bool> {
    let lines: &[Lines<PLACES_OF_LINES>; M] = equations.lines.first_chunk()?;
    let tangents: &[Tangents; M] = equations.tangents.first_chunk()?;
    let blocks = square::<_, M>(&equations.blocks)?;
    let moved_by = square::<_, M>(&influences.of_pairs)?;
    let bubbles = square::<_, M>(&influences.bubbles)?;
    let free: [Moved; M] = *sight.free.first_chunk()?;
    let mut forces: [Quad; M] = *sight.forces.first_chunk()?;
    let per_step = 1.0 / step;
    for i in 0..M {
        let push = tangents[i].push(&free[i], &rates_at_nodes(&free[i], per_step));
        add_multiple(&mut forces[i], 1.0, &push);
    }
    substitute(blocks, &mut forces);
    if !are_finite(&forces) {
        return Some(false);
    }
    let mut missing = [[0.0; CHECKS]; M];
    for i in 0..M {
        let mut moved = free[i];
        for (force, influence) in forces.iter().zip(&moved_by[i]) {
            let mut by_force = [0.0; 4];
            for (force, influence) in force.iter().zip(influence) {
                add_multiple(&mut by_force, *force, influence);
            }
            subtract_multiple(&mut moved, 1.0, &by_force);
        }
        let [deflections, rates] = at_checks(sight.start(i), &moved, step);
        let cubic = cubic_at_checks(&forces[i]);
        for (check, missing) in missing[i].iter_mut().enumerate() {
            let force = lines[i].at(NODES + check, deflections[check], rates[check]);
            *missing = force - cubic[check];
        }
        sight.moved[i] = moved;
        sight.forces[i] = forces[i];
    }
    for i in 0..M {
        let mut drift = [0.0; 2];
        for (missing, bubbles) in missing.iter().zip(&bubbles[i]) {
            for (drift, bubble) in drift.iter_mut().zip(bubbles) {
                *drift -= bubble[0] * missing[0] + bubble[1] * missing[1];
            }
        }
        sight.drift[i] = drift;
        sight.change[i] = tangents[i].change(drift);
    }
    Some(true)
}

/// Overwrites the blocks with what [`substitute`] needs.
#[inline(always)]
#[expect(
    clippy::needless_range_loop,
    reason = "two rows of one matrix: iterators over them are not unrolled"
)]
fn factorize<const M: usize>(blocks: &mut [[Square; M]; M]) {
    for p in 0..M {
        let inverse = inverse_with_one(&blocks[p][p]);
        blocks[p][p] = inverse;
        for q in p + 1..M {
            let factor = times(&blocks[q][p], &inverse);
            blocks[q][p] = factor;
            for r in p + 1..M {
                let above = blocks[p][r];
                subtract_times(&mut blocks[q][r], &factor, &above);
            }
        }
    }
}

/// Overwrites the right-hand sides with the unknowns, from the blocks that [`factorize`] leaves.
#[inline(always)]
fn substitute<const M: usize>(blocks: &[[Square; M]; M], sides: &mut [Quad; M]) {
    for p in 0..M {
        let side = sides[p];
        for q in p + 1..M {
            subtract_product(&mut sides[q], &blocks[q][p], &side);
        }
    }
    for p in (0..M).rev() {
        let mut side = sides[p];
        for q in p + 1..M {
            subtract_product(&mut side, &blocks[p][q], &sides[q]);
        }
        sides[p] = solved(&blocks[p][p], &side);
    }
}

/// The first M x M entries, row by row.
#[inline(always)]
fn square<T, const M: usize>(list: &[T]) -> Option<&[[T; M]; M]> {
    list.as_chunks().0.first_chunk()
}

#[cfg(test)]
mod tests {
    use super::super::super::{Coupling, Row, System};
    use super::super::exchange::Exchange;
    use super::*;

    /// Numbers between -1 and 1 that look random.
    fn fill<'a>(seed: &mut u32, numbers: impl IntoIterator<Item = &'a mut f64>) {
        for number in numbers {
            *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *number = f64::from(*seed >> 8) / f64::from(1 << 23) - 1.0;
        }
    }

    /// Forces, movements and changes at the end that both ways find for the same springs.
    fn both_ways<const M: usize>() -> [Vec<f64>; 2] {
        let coupling = Coupling {
            row: Row::default(),
            column: Row::default(),
        };
        let system = System {
            couplings: vec![coupling; M],
            springs: M,
            ..System::default()
        };
        let exchange = Exchange::between(&[], M);
        let mut influences = Influences::unused(&exchange);
        let mut equations = Equations::new(&system, &exchange);
        let mut sight = Sight::new(M);
        let seed = &mut (M as u32);
        fill(
            seed,
            influences.of_pairs.as_flattened_mut().as_flattened_mut(),
        );
        fill(seed, influences.rates.as_flattened_mut().as_flattened_mut());
        fill(
            seed,
            influences.bubbles.as_flattened_mut().as_flattened_mut(),
        );
        fill(seed, sight.free.as_flattened_mut());
        fill(seed, sight.nodes[0].iter_mut().flatten());
        for lines in &mut equations.lines {
            fill(seed, &mut lines.stiffness);
            fill(seed, &mut lines.damping);
            fill(seed, &mut lines.rest);
        }
        equations.take_tangents();
        let step = 0.7;
        let found = |sight: &Sight| -> Vec<f64> {
            let forces = sight.forces.iter().chain(&sight.moved).flatten();
            let ends = sight.drift.iter().flatten().chain(&sight.change);
            forces.chain(ends).copied().collect()
        };
        assert_eq!(
            prepare::<M>(&mut equations, &influences, &mut sight),
            Some(true)
        );
        assert_eq!(
            solve::<M>(&equations, &influences, step, &mut sight),
            Some(true)
        );
        let few = found(&sight);
        assert!(equations.prepare(&influences, &mut sight));
        assert!(equations.solve(step, &mut sight));
        sight.exert(&exchange, &influences);
        equations.compare(step, &mut sight);
        exchange.exert_missing(&influences, &sight.missing, &mut sight.drift);
        equations.change(&mut sight);
        [few, found(&sight)]
    }

    #[test]
    fn few_springs_move_as_any_number_does() {
        for [few, any] in [both_ways::<1>(), both_ways::<2>(), both_ways::<3>()] {
            let size = any.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
            for (few, any) in few.iter().zip(&any) {
                // 1e-13: rounding of some dozen operations, in another order.
                assert!((few - any).abs() <= 1e-13 * size, "{few:e}, {any:e}");
            }
        }
    }
}
