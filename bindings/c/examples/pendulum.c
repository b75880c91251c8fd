/* Opens a lab of a lesson, changes a control, plays it, and prints what it shows.
 *     pendulum specs/lessons/02-bounce-and-swing.md specs/models */
#include "labspec.h"
#include <stdio.h>
#include <stdlib.h>

static void check(labspec_status status)
{
    if (status != LABSPEC_OK) {
        fprintf(stderr, "%s: %s\n", labspec_last_error_code(), labspec_last_error());
        exit(1);
    }
}

int main(int argc, char **argv)
{
    static char lesson[100000];
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    if (file == NULL || fread(lesson, 1, sizeof lesson - 1, file) == 0 || fclose(file) != 0) {
        fprintf(stderr, "usage: %s LESSON MODELS\n", argv[0]);
        return 2;
    }
    labspec_model_source models = {.struct_size = sizeof models, .folder = argv[2]};
    labspec_lab *lab = NULL;
    check(labspec_lab_open_lesson(argv[1], lesson, "#2", &models, &lab));
    check(labspec_lab_set_number(lab, "start", 1.5));

    double numbers[8];
    char height[32];
    for (int i = 0; i < 4; i++) {
        size_t count = 0;
        double time = 0;
        check(labspec_lab_time(lab, &time));
        check(labspec_lab_numbers(lab, numbers, 8, &count));
        check(labspec_lab_text(lab, count - 1, height, sizeof height, NULL));
        printf("%.3f s: angle %.17g rad, height %s m\n", time, numbers[0], height);
        check(labspec_lab_step(lab, 100));
    }
    check(labspec_lab_free(lab));
    return 0;
}
