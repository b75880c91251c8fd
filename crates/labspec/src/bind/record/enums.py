"""Writes enums.rs: names and numbers of the library's enumerations that a lesson can name, as the installed library
reports them. Run with the Python that has the library: python record/enums.py > enums.rs"""
import mujoco

WANTED = """mjtObj mjtJoint mjtGeom mjtIntegrator mjtCone mjtSolver mjtJacobian mjtEq mjtTrn mjtDyn mjtGain mjtBias
mjtWrap mjtSensor mjtDisableBit mjtEnableBit mjtWarning mjtTimer mjtState mjtConstraint mjtConstraintState mjtStage
mjtDataType mjtCamLight mjtLightType mjtTexture mjtSameFrame""".split()
print(f"//! Enumerations of MuJoCo {mujoco.__version__}, as `record/enums.py` finds them in the library. Not written by hand.\n")
print("/// Name, and its members with their numbers.")
print("pub(super) const ENUMS: &[(&str, &[(&str, i64)])] = &[")
for name in WANTED:
    enum = getattr(mujoco, name, None)
    if enum is None:
        continue
    print(f'    ("{name}", &[')
    for member, value in enum.__members__.items():
        print(f'        ("{member}", {int(value)}),')
    print("    ]),")
print("];")
