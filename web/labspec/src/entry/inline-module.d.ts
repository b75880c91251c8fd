/** The module, compressed, in base64. */
declare const text: string;
export default text;
