"""python -m reference MODEL.toml --frequencies | --simulate STOP STEP"""
import json
import sys

import numpy as np

from . import System, coupled, frequencies, simulate


def main(args):
    model = System(args[0])
    if "--frequencies" in args:
        meshes = [dict(name=m.name, frequency=abs(m.rate), mean_stiffness=m.mean, damping=m.c) for m in model.meshes]
        print(json.dumps(dict(rotors=frequencies(model), meshes=meshes, coupled=coupled(model)), indent=1))
    if "--simulate" in args:
        stop, step = map(float, args[args.index("--simulate") + 1:][:2])
        out = simulate(model, stop, np.minimum(np.arange(round(stop / step) + 1) * step, stop))
        out.pop("state")
        print(",".join(out))
        for line in zip(*out.values()):
            print(",".join(repr(float(x)) for x in line))


if __name__ == "__main__":
    main(sys.argv[1:])
