/* Two threads step two labs and two data of one model at a time; then both call one lab, where each call works or is refused. */
#include "labspec.h"
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static const char *const BALL =
    "<mujoco><worldbody><geom type='plane' size='1 1 1'/>"
    "<body name='bob' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>";
static const char *const LAB =
    "{\"model\": \"ball\", \"readouts\": [{\"label\": \"h\", \"expr\": \"data.body('bob').xpos[2]\"}]}";

static labspec_lab *shared;
static labspec_model *model;

struct result {
    double height, z;
    int failures, refused;
};

static void *run(void *argument)
{
    struct result *result = argument;
    const char *names[1] = {"ball"}, *texts[1] = {BALL};
    labspec_model_source models = {.struct_size = sizeof models, .count = 1, .names = names, .texts = texts};
    labspec_lab *lab = NULL;
    labspec_data *data = NULL;
    double qpos[7] = {0};
    int bad = labspec_lab_open(LAB, &models, &lab) != LABSPEC_OK || labspec_data_new(model, &data) != LABSPEC_OK;
    for (int i = 0; i < 300 && !bad; i++) {
        bad |= labspec_lab_step(lab, 1) != LABSPEC_OK || labspec_data_step(data, 1) != LABSPEC_OK;
    }
    bad |= labspec_lab_numbers(lab, &result->height, 1, NULL) != LABSPEC_OK;
    bad |= labspec_data_read(data, "qpos", qpos, 7, NULL) != LABSPEC_OK;
    for (int i = 0; i < 100; i++) {
        labspec_status status = labspec_lab_step(shared, 30);
        if (status == LABSPEC_ERROR_BUSY) {
            bad |= strcmp(labspec_last_error_code(), "busy") != 0;
            result->refused++;
        } else {
            bad |= status != LABSPEC_OK;
        }
    }
    bad |= labspec_lab_free(lab) != LABSPEC_OK || labspec_data_free(data) != LABSPEC_OK;
    result->z = qpos[2];
    result->failures = bad;
    return NULL;
}

int main(void)
{
    const char *names[1] = {"ball"}, *texts[1] = {BALL};
    labspec_model_source models = {.struct_size = sizeof models, .count = 1, .names = names, .texts = texts};
    struct result results[2];
    pthread_t threads[2];
    double time = 0;
    memset(results, 0, sizeof results);
    if (labspec_lab_open(LAB, &models, &shared) != LABSPEC_OK || labspec_model_from_xml(BALL, NULL, &model) != LABSPEC_OK) return 1;
    for (int i = 0; i < 2; i++) {
        if (pthread_create(&threads[i], NULL, run, &results[i]) != 0) return 1;
    }
    for (int i = 0; i < 2; i++) pthread_join(threads[i], NULL);
    int made = 200 - results[0].refused - results[1].refused;
    int bad = results[0].failures || results[1].failures || results[0].height != results[1].height || results[0].z != results[1].z;
    bad |= labspec_lab_time(shared, &time) != LABSPEC_OK || (int)(time / 0.002 + 0.5) != 30 * made;
    bad |= labspec_lab_free(shared) != LABSPEC_OK || labspec_model_free(model) != LABSPEC_OK;
    printf("threads: %d calls of the shared lab, %d refused, %s\n", made, 200 - made, bad ? "failed" : "ok");
    return bad;
}
