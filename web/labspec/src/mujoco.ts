export default async function loadMujoco(): Promise<Record<string, unknown>> { return {}; }
