/* Texts that are nested deeply end in an error or a result on a thread with a stack of 2 MB, which the header requires. */
#define _POSIX_C_SOURCE 200809L
#include "labspec.h"
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *nested(const char *head, const char *open, const char *middle, const char *close, const char *tail, size_t depth)
{
    size_t size = strlen(head) + strlen(middle) + strlen(tail) + depth * (strlen(open) + strlen(close)) + 1;
    char *text = malloc(size), *end = text;
    if (text == NULL) exit(2);
    end = stpcpy(end, head);
    for (size_t i = 0; i < depth; i++) end = stpcpy(end, open);
    end = stpcpy(end, middle);
    for (size_t i = 0; i < depth; i++) end = stpcpy(end, close);
    stpcpy(end, tail);
    return text;
}

static void *run(void *argument)
{
    size_t *done = argument;
    const char *const lab = "{\"xml\": \"<mujoco/>\", \"readouts\": [{\"label\": \"a\", \"expr\": \"";
    for (size_t depth = 50; depth <= 51200; depth *= 4) {
        labspec_model *model = NULL;
        labspec_lab *opened = NULL;
        labspec_check_report *report = NULL;
        char *texts[] = {
            nested("<mujoco><worldbody>", "<body><geom size='1'/>", "", "</body>", "</worldbody></mujoco>", depth),
            nested("{\"model\": ", "[", "1", "]", "}", depth),
            nested(lab, "(", "1", ")", "\"}]}", depth),
            nested(lab, "!-", "1", "", "\"}]}", depth),
            nested("", ">", "x", "", "\n", depth),
        };
        labspec_model_from_xml(texts[0], NULL, &model);
        for (int i = 1; i < 4; i++) {
            labspec_lab_open(texts[i], NULL, &opened);
            labspec_lab_free(opened);
        }
        if (labspec_check("a.md", texts[4], NULL, NULL, &report) != LABSPEC_OK) exit(1);
        labspec_check_report_free(report);
        labspec_model_free(model);
        for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) free(texts[i]);
        *done = depth;
    }
    return NULL;
}

int main(void)
{
    pthread_attr_t attributes;
    pthread_t thread;
    size_t done = 0;
    if (pthread_attr_init(&attributes) != 0 || pthread_attr_setstacksize(&attributes, 2 << 20) != 0) return 2;
    if (pthread_create(&thread, &attributes, run, &done) != 0 || pthread_join(thread, NULL) != 0) return 2;
    printf("texts nested %zu deep\n", done);
    return done != 51200;
}
