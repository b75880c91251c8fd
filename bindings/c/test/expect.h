/* What the tests share: a lab, its model, and calls that are compared with the status that is expected. */
#include "labspec.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0, calls = 0;

static void expect(labspec_status wanted, labspec_status found, const char *call, int line)
{
    calls++;
    if (wanted != found) {
        failures++;
        printf("%d: %s: %s instead of %s: %s\n", line, call, labspec_status_name((int32_t)found),
               labspec_status_name((int32_t)wanted), labspec_last_error());
    }
    if (labspec_last_error_status() != found || (found == LABSPEC_OK) != (labspec_last_error_length() == 0) ||
        strlen(labspec_last_error()) != labspec_last_error_length() ||
        (found == LABSPEC_OK) != (labspec_last_error_code()[0] == 0)) {
        failures++;
        printf("%d: %s: the last error is not that of the call\n", line, call);
    }
}

#define OK(call) expect(LABSPEC_OK, call, #call, __LINE__)
#define FAILS(status, call) expect(LABSPEC_ERROR_##status, call, #call, __LINE__)
#define CHECK(condition) (calls++, (condition) ? 0 : (failures++, printf("%d: %s\n", __LINE__, #condition)))

#define DROP \
    "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/>" \
    "<body name='bob' pos='0 0 1'><freejoint name='fall'/><geom size='0.1'/></body></worldbody>" \
    "<keyframe><key qpos='0 0 2 1 0 0 0'/></keyframe></mujoco>"
static const char *const LAB =
    "{\"model\": \"drop\", \"controls\": ["
    "{\"label\": \"gravity\", \"unit\": \"m/s^2\", \"set\": \"model.opt.gravity[2]\", \"min\": -20, \"max\": -1, \"step\": 0.1,"
    " \"value\": -9.8, \"reset\": true},"
    "{\"type\": \"select\", \"label\": \"push\", \"param\": \"push\", \"options\": [[\"no\", 0], [\"yes\", 1]], \"value\": 0},"
    "{\"type\": \"button\", \"label\": \"kick\", \"run\": \"data.qvel[2] = 1\"}],"
    " \"plots\": [{\"traces\": [{\"label\": \"h (m)\", \"expr\": \"data.body('bob').xpos[2]\"}]}],"
    " \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.body('bob').xpos[2]\", \"digits\": 2}]}";
__attribute__((unused)) static const char *const LESSON = "Falls.\n```lab\n{\"model\": \"drop\", \"readouts\": [{\"label\": \"h\", \"expr\": "
                                  "\"data.body('bop').xpos[2]\"}]}\n```\n";
__attribute__((unused)) static const char BAD[] = "\xff\xfe";

static const char *names[1] = {"drop"}, *texts[1] = {DROP};
static labspec_model_source models = {.struct_size = sizeof models, .count = 1, .names = names, .texts = texts};
